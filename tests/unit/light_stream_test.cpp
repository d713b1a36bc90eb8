// SPDX-License-Identifier: Apache-2.0
// Streams of fields: what a client has is what the server coded, whatever is lost on the way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "field/field_access.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "lambent/stream.h"
#include "stream/light/message.h"
#include "support/field_scenes.h"

namespace lambent::stream {
namespace {

using ::testing::HasSubstr;

/// A Cornell box whose lamp changes, and a field that follows it.
class Box {
 public:
  explicit Box(const FieldSettings& settings = small_field())
      : scene_(scenes::make("cornell").value()), world_(scene_), field_(made(settings)) {
    for (int i = 0; i < 4; ++i) field_.update(world_);
  }

  static FieldSettings small_field() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(5, 5, 5);
    settings.rays_per_probe = 32;
    settings.corrections = false;
    return settings;
  }

  void shine(float factor) {
    for (Material& material : scene_.materials) material.emission *= factor;
    ASSERT_TRUE(world_.update());
    field_.update(world_);
  }
  /// A step of light that swells and fades.
  void advance() { shine(++steps_ % 6 < 3 ? 1.2f : 1.0f / 1.2f); }
  void look_from(const glm::vec3& viewer) { field_.update(world_, {.viewer_ws = viewer}); }

  const IrradianceField& field() const { return field_; }
  const World& world() const { return world_; }

 private:
  IrradianceField made(const FieldSettings& settings) const {
    return std::move(IrradianceField::make(settings, open_bounds(world_)).value());
  }

  Scene scene_;
  World world_;
  IrradianceField field_;
  int steps_ = 0;
};

using Messages = std::vector<LightMessage>;

LightEncoder made_encoder(const LightEncoderSettings& settings = {}) {
  return std::move(LightEncoder::create(settings).value());
}

Messages encoded(LightEncoder& encoder, const Box& box) {
  Expected<Messages> messages = encoder.encode(box.field());
  if (!messages) throw std::runtime_error(messages.error().message());
  return std::move(*messages);
}

template <class Client>
void receive_all(Client& client, const Messages& messages) {
  for (const LightMessage& message : messages) {
    const Expected<void> fine = client.receive(message.bytes);
    ASSERT_TRUE(fine) << fine.error().message();
  }
}

/// All that a decoder tells of its state.
struct Decoded {
  std::uint64_t update = 0;
  std::vector<glm::vec3> light, places;
  std::vector<glm::vec2> distances;
  bool operator==(const Decoded&) const = default;
};

Decoded state_of(const LightDecoder& decoder) {
  Decoded state;
  state.update = decoder.update();
  std::vector<glm::vec3> tile(decoder.irradiance_texels() * decoder.irradiance_texels());
  std::vector<glm::vec2> moments(decoder.distance_texels() * decoder.distance_texels());
  for (int probe = 0; probe < decoder.probes(); ++probe) {
    decoder.irradiance(probe, tile);
    decoder.distances(probe, moments);
    state.light.insert(state.light.end(), tile.begin(), tile.end());
    state.distances.insert(state.distances.end(), moments.begin(), moments.end());
    state.places.push_back(decoder.position_ws(probe));
  }
  return state;
}

/// LightErrors of a decoder's light, found anew from the field's store.
LightErrors errors_of(const LightDecoder& decoder, const IrradianceField& field) {
  const ProbeStore& store = store_of(field);
  const int edge = store.irradiance_texels();
  std::vector<glm::vec3> tile(edge * edge);
  std::vector<std::pair<double, double>> pairs;
  double mean = 0.0;
  for (int probe = 0; probe < decoder.probes(); ++probe) {
    if (statuses_of(field)[probe].state == ProbeState::off) continue;
    decoder.irradiance(probe, tile);
    for (int t = 0; t < edge * edge; ++t) {
      const vec3 truth = store.irradiance_texel(probe, ivec2(t % edge, t / edge) + 1);
      for (int c = 0; c < 3; ++c) {
        pairs.emplace_back(tile[t][c], truth[c]);
        mean += truth[c];
      }
    }
  }
  mean /= static_cast<double>(pairs.size());
  double square = 0.0, dark = 0.0;
  for (const auto& [decoded, truth] : pairs) {
    square += (decoded - truth) * (decoded - truth);
    dark += std::pow((decoded - truth) / (truth + 0.1 * mean), 2.0);
  }
  const auto count = static_cast<double>(pairs.size());
  return {std::sqrt(square / count) / mean, std::sqrt(dark / count)};
}

/// What a store of floats holds is what the field's light is.
FieldSettings exact_field() {
  FieldSettings settings = Box::small_field();
  settings.irradiance_format = IrradianceFormat::float32;
  return settings;
}

TEST(LightStream, KeepsBothErrorsBelowTheTargetInEveryUpdate) {
  for (const float target : {0.05f, 0.01f, 0.002f}) {
    Box box(exact_field());
    LightEncoder encoder = made_encoder({.target_error = target});
    LightDecoder client;
    for (int update = 0; update < 14; ++update) {
      receive_all(client, encoded(encoder, box));
      const LightErrors errors = errors_of(client, box.field());
      EXPECT_LE(errors.relative, 1.001 * target) << update;
      EXPECT_LE(errors.dark, 1.001 * target) << update;
      // The encoder knows what clients have
      EXPECT_NEAR(errors.relative, encoder.errors().relative, 1e-3 * target) << update;
      EXPECT_NEAR(errors.dark, encoder.errors().dark, 1e-3 * target) << update;
      box.advance();
    }
  }
}

TEST(LightStream, GivesLateJoinersWhatOthersHaveToTheBit) {
  Box box;
  LightEncoder encoder = made_encoder();
  LightDecoder first;
  for (int update = 0; update < 6; ++update) {
    receive_all(first, encoded(encoder, box));
    box.advance();
  }
  LightDecoder late;
  EXPECT_TRUE(late.needs_key());
  receive_all(late, encoder.join().value());
  EXPECT_FALSE(late.needs_key());
  EXPECT_EQ(state_of(late), state_of(first));
  for (int update = 0; update < 12; ++update) {
    const Messages messages = encoded(encoder, box);
    receive_all(first, messages);
    receive_all(late, messages);
    ASSERT_EQ(state_of(late), state_of(first));
    box.advance();
  }
  EXPECT_EQ(late.update(), 18u);
}

TEST(LightStream, RefusesWhatFollowsOnALossUntilAKeyComes) {
  Box box;
  LightEncoder encoder = made_encoder();
  LightDecoder whole, lossy;
  for (int update = 0; update < 3; ++update) {
    const Messages messages = encoded(encoder, box);
    receive_all(whole, messages);
    receive_all(lossy, messages);
    box.advance();
  }
  const Messages lost = encoded(encoder, box);
  receive_all(whole, lost);
  box.advance();
  const Decoded before = state_of(lossy);
  for (int update = 0; update < 3; ++update) {
    const Messages messages = encoded(encoder, box);
    receive_all(whole, messages);
    for (const LightMessage& message : messages) EXPECT_FALSE(lossy.receive(message.bytes));
    EXPECT_TRUE(lossy.needs_key());
    EXPECT_EQ(state_of(lossy), before);
    box.advance();
  }
  // Geometry is not sent to those who have it
  const Messages key = encoder.join(lossy.geometry()).value();
  EXPECT_EQ(key.back().kind, LightMessageKind::key);
  receive_all(lossy, key);
  EXPECT_FALSE(lossy.needs_key());
  EXPECT_EQ(state_of(lossy), state_of(whole));
  const Messages next = encoded(encoder, box);
  receive_all(whole, next);
  receive_all(lossy, next);
  EXPECT_EQ(state_of(lossy), state_of(whole));
}

TEST(LightStream, IgnoresWhatComesTwiceOrLate) {
  Box box;
  LightEncoder encoder = made_encoder();
  LightDecoder client;
  std::vector<Messages> all;
  for (int update = 0; update < 4; ++update) {
    all.push_back(encoded(encoder, box));
    receive_all(client, all.back());
    box.advance();
  }
  const Decoded before = state_of(client);
  for (const Messages& messages : all) {
    const Expected<void> late = client.receive(messages.back().bytes);
    ASSERT_FALSE(late);
    EXPECT_THAT(late.error().message(), HasSubstr("comes too late"));
  }
  EXPECT_FALSE(client.needs_key());
  EXPECT_EQ(state_of(client), before);
  receive_all(client, encoded(encoder, box));
}

TEST(LightStream, RefusesAnotherStream) {
  Box box;
  LightEncoder encoder = made_encoder({.stream = 1}), other = made_encoder({.stream = 2});
  LightDecoder client;
  receive_all(client, encoded(encoder, box));
  encoded(other, box);
  box.advance();
  const Decoded before = state_of(client);
  EXPECT_FALSE(client.receive(encoded(other, box).back().bytes));
  EXPECT_EQ(state_of(client), before);
  EXPECT_TRUE(client.needs_key());
  // Its geometry has the same update, but is another stream's
  receive_all(client, other.join(client.geometry()).value());
  EXPECT_FALSE(client.needs_key());
  EXPECT_EQ(client.update(), 2u);
}

TEST(LightStream, RefusesAKeyOfGeometryThatIsNotThere) {
  Box box;
  LightEncoder encoder = made_encoder();
  const Messages messages = encoded(encoder, box);
  ASSERT_EQ(messages.size(), 2u);
  LightDecoder client;
  const Expected<void> refused = client.receive(messages[1].bytes);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("geometry"));
  EXPECT_EQ(client.probes(), 0);
  receive_all(client, messages);
  EXPECT_EQ(client.probes(), 125);
}

TEST(LightStream, RefusesBrokenMessagesAndKeepsItsState) {
  Box box;
  LightEncoder encoder = made_encoder();
  LightDecoder client;
  receive_all(client, encoded(encoder, box));
  box.advance();
  Messages messages = encoder.join().value();
  for (LightMessage& message : encoded(encoder, box)) messages.push_back(std::move(message));
  const Decoded before = state_of(client);
  std::mt19937 random(7);
  for (const LightMessage& message : messages) {
    for (int run = 0; run < 60; ++run) {
      std::vector<std::byte> broken = message.bytes;
      broken[random() % broken.size()] ^= static_cast<std::byte>(1u << random() % 8);
      const Expected<void> refused = client.receive(broken);
      ASSERT_FALSE(refused);
      EXPECT_FALSE(refused.error().cause.empty());
      const std::size_t size = random() % message.bytes.size();
      EXPECT_FALSE(client.receive(std::span(message.bytes).first(size)));
    }
    std::vector<std::byte> longer = message.bytes;
    longer.insert(longer.end(), 8, std::byte{1});
    EXPECT_FALSE(client.receive(longer));
    seal_message(longer);
    LightDecoder copy;
    receive_all(copy, {messages[0], messages[1]});
    EXPECT_FALSE(copy.receive(longer));
  }
  EXPECT_EQ(state_of(client), before);
  EXPECT_FALSE(client.needs_key());
  receive_all(client, {messages.back()});
}

TEST(LightStream, SendsNextToNothingWhereNothingChanges) {
  Box box;
  LightEncoder encoder = made_encoder();
  LightDecoder client;
  receive_all(client, encoded(encoder, box));
  std::size_t bytes = 0;
  for (int update = 0; update < 20; ++update) {
    for (const LightMessage& message : encoded(encoder, box)) {
      EXPECT_EQ(message.kind, LightMessageKind::delta);
      bytes += message.bytes.size();
      ASSERT_TRUE(client.receive(message.bytes));
    }
  }
  EXPECT_TRUE(client.changed().empty());
  // Headers of 32 bytes, and at first some corrections of what the key rounded
  EXPECT_LE(bytes, 20u * 40u);
}

TEST(LightStream, BeginsAnewWhereLightIsOfAnotherBrightness) {
  Box box(exact_field());
  LightEncoder encoder = made_encoder();
  LightDecoder client;
  receive_all(client, encoded(encoder, box));
  for (const float factor : {1e-4f, 1e6f, 1e-2f}) {
    box.shine(factor);
    const Messages messages = encoded(encoder, box);
    EXPECT_EQ(messages.back().kind, LightMessageKind::key) << factor;
    receive_all(client, messages);
    EXPECT_LE(errors_of(client, box.field()).dark, 0.01);
  }
}

TEST(LightStream, WorksWithTilesOfAllSizes) {
  for (const auto& [irradiance, distance] : {std::pair(2, 4), std::pair(6, 9), std::pair(16, 32)}) {
    FieldSettings settings = exact_field();
    settings.probe_count = glm::ivec3(3);
    settings.irradiance_texels = irradiance;
    settings.distance_texels = distance;
    Box box(settings);
    LightEncoder encoder = made_encoder();
    LightDecoder client;
    for (int update = 0; update < 3; ++update) {
      receive_all(client, encoded(encoder, box));
      EXPECT_LE(errors_of(client, box.field()).relative, 0.01) << irradiance;
      box.advance();
    }
    EXPECT_EQ(client.irradiance_texels(), irradiance);
    EXPECT_EQ(client.distance_texels(), distance);
  }
}

TEST(LightStream, FollowsCascadesThatScroll) {
  constexpr float kSpacing = 0.8f;  // The box is 5.5 wide
  FieldSettings settings = exact_field();
  settings.cascades = 2;
  settings.probe_count = glm::ivec3(8);
  settings.probe_spacing = kSpacing;
  Box box(settings);
  LightEncoder encoder = made_encoder();
  StreamedField client;
  const glm::vec3 middle = box.field().grids()[0].origin + 3.5f * kSpacing;
  bool scrolled = false;
  for (int update = 0; update < 5; ++update) {
    box.look_from(middle + glm::vec3(1.1f * kSpacing * static_cast<float>(update), 0.0f, 0.0f));
    const Messages messages = encoded(encoder, box);
    receive_all(client, messages);
    scrolled = scrolled || (update > 0 && messages.front().kind == LightMessageKind::geometry);
    EXPECT_LE(errors_of(client.decoder(), box.field()).relative, 0.01);
    ASSERT_EQ(client.field()->grids().size(), 2u);
    for (int v = 0; v < 2; ++v) {
      EXPECT_EQ(client.field()->grids()[v].origin, box.field().grids()[v].origin);
    }
    for (int probe = 0; probe < box.field().probes(); probe += 37) {
      EXPECT_EQ(client.decoder().position_ws(probe),
                store_of(box.field()).probe_position_ws(probe));
    }
  }
  EXPECT_TRUE(scrolled);
}

TEST(LightStream, SendsDistancesAgainWhereTheyAreOff) {
  Box box;
  LightEncoder rough = made_encoder({.distance_threshold = 0.3f});
  LightEncoder fine = made_encoder({.distance_threshold = 0.001f});
  LightDecoder client;
  receive_all(client, encoded(fine, box));
  encoded(rough, box);
  std::size_t rough_bytes = 0, fine_bytes = 0;
  for (int update = 0; update < 8; ++update) {
    // New rays, which average distances a little further
    box.look_from(glm::vec3(0.0f));
    for (const LightMessage& message : encoded(rough, box)) {
      rough_bytes += message.kind == LightMessageKind::geometry ? message.bytes.size() : 0;
    }
    const Messages messages = encoded(fine, box);
    receive_all(client, messages);
    for (const LightMessage& message : messages) {
      fine_bytes += message.kind == LightMessageKind::geometry ? message.bytes.size() : 0;
    }
  }
  EXPECT_GT(fine_bytes, 10 * rough_bytes);
  // A client that was there and one that is new know the same
  LightDecoder late;
  receive_all(late, fine.join().value());
  EXPECT_EQ(state_of(late), state_of(client));
}

TEST(LightStream, SaysWhatItCannotDo) {
  EXPECT_FALSE(LightEncoder::create({.target_error = 0.0f}));
  EXPECT_FALSE(LightEncoder::create({.target_error = std::nanf("")}));
  EXPECT_FALSE(LightEncoder::create({.distance_threshold = 0.0f}));
  LightEncoder encoder = made_encoder();
  const Expected<Messages> nothing = encoder.join();
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message(), HasSubstr("no light"));
  // A field of 125 probes does not fit into 100 kB
  Box box;
  LightDecoder small(100'000);
  const Expected<void> refused = small.receive(encoded(encoder, box).front().bytes);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("memory"));
}

}  // namespace
}  // namespace lambent::stream
