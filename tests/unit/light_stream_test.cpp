// SPDX-License-Identifier: Apache-2.0
// Streams of fields of all kinds: how exact they are, and what they take.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/light_box.h"

namespace lambent::stream::light_stream_test {
namespace {

using test::Box;
using test::encoded;
using test::errors_of;
using test::exact_field;
using test::made_encoder;
using test::Messages;
using test::receive_all;
using test::state_of;
using ::testing::HasSubstr;

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
}  // namespace lambent::stream::light_stream_test
