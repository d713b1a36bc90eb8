// SPDX-License-Identifier: Apache-2.0
// What a client renders from a stream beside what the server renders itself.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "field/field_access.h"
#include "lambent/renderer.h"
#include "lambent/stream.h"
#include "support/field_scenes.h"

namespace lambent::stream::streamed_field_test {
namespace {

/// Root mean square of the difference of a layer of two frames, over the first one's mean.
double difference(const RenderedFrame& a, const RenderedFrame& b, const std::string& layer) {
  const std::vector<float>& x = a.image.find(layer)->pixels;
  const std::vector<float>& y = b.image.find(layer)->pixels;
  EXPECT_EQ(x.size(), y.size());
  double square = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    square += (x[i] - y[i]) * (x[i] - y[i]);
    sum += x[i];
  }
  const auto count = static_cast<double>(x.size());
  return std::sqrt(square / count) / (sum / count);
}

/// What a client has: a scene of its own, and light from a stream.
struct Client {
  Scene scene = scenes::make("cornell").value();
  World world{scene};
  StreamedField light;

  void receive(const std::vector<LightMessage>& messages) {
    for (const LightMessage& message : messages) {
      const Expected<void> fine = light.receive(message.bytes);
      ASSERT_TRUE(fine) << fine.error().message();
    }
  }
  RenderedFrame render(const FrameSettings& settings) const {
    return rendered(world, *light.field(), scene.cameras.front(), settings);
  }
  static RenderedFrame rendered(const World& world, const IrradianceField& field,
                                const Camera& camera, const FrameSettings& settings) {
    return Renderer(world, {.field = &field}).render(camera, settings).value();
  }
};

FrameSettings small_frame(Quality quality) {
  FrameSettings settings = quality_settings(quality);
  settings.width = settings.height = 96;
  return settings;
}

/// A server's box, whose lamp changes.
struct Server {
  Scene scene = scenes::make("cornell").value();
  World world{scene};
  IrradianceField field;
  LightEncoder encoder = std::move(LightEncoder::create({.target_error = 0.005f}).value());

  explicit Server(bool corrections = false) : field(made(world, corrections)) {}
  static IrradianceField made(const World& world, bool corrections) {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(8);
    settings.corrections = corrections;
    return std::move(IrradianceField::make(settings, open_bounds(world)).value());
  }
  std::vector<LightMessage> shine(float factor) {
    for (Material& material : scene.materials) material.emission *= factor;
    EXPECT_TRUE(world.update());
    for (int i = 0; i < 4; ++i) field.update(world);
    return encoder.encode(field).value();
  }
};

TEST(StreamedField, RendersWhatTheServerRenders) {
  Server server;
  Client client;
  EXPECT_EQ(client.light.field(), nullptr);
  const IrradianceField* place = nullptr;
  for (const float factor : {1.0f, 0.7f, 0.5f}) {
    client.receive(server.shine(factor));
    // The client sees what happens, and learns of indirect light from the stream alone
    if (factor != 1.0f) {
      for (Material& material : client.scene.materials) material.emission *= factor;
      ASSERT_TRUE(client.world.update());
    }
    ASSERT_NE(client.light.field(), nullptr);
    if (place != nullptr) {
      EXPECT_EQ(client.light.field(), place);
    }
    place = client.light.field();
    for (const Quality quality : {Quality::draft, Quality::interactive}) {
      const FrameSettings settings = small_frame(quality);
      const RenderedFrame there =
          Client::rendered(server.world, server.field, server.scene.cameras.front(), settings);
      const RenderedFrame here = client.render(settings);
      EXPECT_EQ(difference(there, here, "direct"), 0.0);
      // Light is within 0.5 %, and distances within half a hundredth of a spacing
      EXPECT_LT(difference(there, here, "indirect"), 0.01);
      EXPECT_LT(difference(there, here, ""), 0.005);
    }
  }
}

TEST(StreamedField, CorrectsLookupsAsTheServerDoes) {
  Server server(true);
  Client client;
  client.receive(server.shine(1.0f));
  const FrameSettings settings = small_frame(Quality::draft);
  const Camera& camera = server.scene.cameras.front();
  const RenderedFrame there = Client::rendered(server.world, server.field, camera, settings);
  // They can come later
  EXPECT_GT(difference(there, client.render(settings), "indirect"), 0.05);
  EXPECT_FALSE(client.light.decoder().has_corrections());
  client.receive(server.encoder.corrections());
  EXPECT_TRUE(client.light.decoder().has_corrections());
  // Ratios are within a hundredth, and where few samples count, by a fifth more or less of them
  EXPECT_LT(difference(there, client.render(settings), "indirect"), 0.015);

  // A field without what was learned is far off
  Server plain(false);
  plain.shine(1.0f);
  const RenderedFrame without = Client::rendered(plain.world, plain.field, camera, settings);
  EXPECT_GT(difference(there, without, "indirect"), 0.05);

  // What is learned later is sent when the number of updates is four times as large
  const std::uint64_t first = server.encoder.corrections_number();
  for (int i = 0; i < 3; ++i) client.receive(server.shine(1.0f));
  EXPECT_NE(server.encoder.corrections_number(), first);
  client.receive(server.encoder.corrections());
  const RenderedFrame later = Client::rendered(server.world, server.field, camera, settings);
  EXPECT_LT(difference(later, client.render(settings), "indirect"), 0.015);
}

TEST(StreamedField, IsFarFromTheServerWhereNothingCameFromIt) {
  // The bars above would show light that is a tenth off
  Server server;
  Client client;
  client.receive(server.shine(1.0f));
  server.shine(0.9f);
  const FrameSettings settings = small_frame(Quality::draft);
  const RenderedFrame there =
      Client::rendered(server.world, server.field, server.scene.cameras.front(), settings);
  EXPECT_GT(difference(there, client.render(settings), "indirect"), 0.05);
}

TEST(StreamedField, LeaksNoMoreThroughWallsThanTheServersField) {
  const Scene scene = scenes::make("two-rooms-sealed").value();
  const World world(scene);
  FieldSettings settings;
  settings.corrections = false;
  IrradianceField field = IrradianceField::make(settings, open_bounds(world)).value();
  for (int i = 0; i < 8; ++i) field.update(world);
  LightEncoder encoder = std::move(LightEncoder::create().value());
  StreamedField light;
  const auto messages = encoder.encode(field);
  ASSERT_TRUE(messages);
  for (const LightMessage& message : *messages) ASSERT_TRUE(light.receive(message.bytes));
  const auto mean = [&](const IrradianceField& of, const Camera& camera) {
    const RenderedFrame frame = Client::rendered(world, of, camera, small_frame(Quality::draft));
    const std::vector<float>& pixels = frame.image.find("indirect")->pixels;
    return std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
  };
  // The first camera is in the room that no light gets into
  const double lit = mean(field, scene.cameras[1]);
  EXPECT_GT(lit, 1.0);
  EXPECT_NEAR(mean(*light.field(), scene.cameras[1]), lit, 0.002 * lit);
  EXPECT_LT(mean(field, scene.cameras[0]), 1e-5 * lit);
  EXPECT_LT(mean(*light.field(), scene.cameras[0]), 1e-5 * lit);
}

TEST(StreamedField, AnswersQueriesWithoutAWorld) {
  Server server;
  StreamedField light;
  for (const LightMessage& message : server.shine(1.0f)) ASSERT_TRUE(light.receive(message.bytes));
  const test::Stage stage("cornell");
  const std::vector<FieldQuery> queries = test::seen_points(stage);
  const std::vector<glm::vec3> here = test::look_up(*light.field(), queries);
  const std::vector<glm::vec3> there = test::look_up(server.field, queries);
  double square = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    square += glm::dot(here[i] - there[i], here[i] - there[i]);
    sum += there[i].x + there[i].y + there[i].z;
  }
  const double count = 3.0 * static_cast<double>(queries.size());
  EXPECT_LT(std::sqrt(square / count) / (sum / count), 0.01);
}

}  // namespace
}  // namespace lambent::stream::streamed_field_test
