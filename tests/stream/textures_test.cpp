// SPDX-License-Identifier: Apache-2.0
// Light through H.265, where this was built with it.
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "stream/client/lit_scene.h"
#include "stream/light/message.h"
#include "stream/textures/h265.h"
#include "support/light_box.h"
#include "support/served_scene.h"

namespace lambent::stream::textures_test {
namespace {

using test::Box;
using test::exact_field;
using test::Messages;
using test::state_of;

// What 10 bits can hold in a box whose lamp shines on a wall from near.
constexpr float kTarget = 0.018f;

class Textures : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_h265()) GTEST_SKIP() << "built without LAMBENT_STREAM_H265";
  }
  static LightEncoder made_encoder(float target = kTarget) {
    LightEncoderSettings settings;
    settings.target_error = target;
    return std::move(LightEncoder::create(settings, make_h265_writer().value()).value());
  }
  static LightDecoder made_decoder() {
    LightDecoder decoder;
    decoder.read_textures(make_h265_reader().value());
    return decoder;
  }
  /// What somebody needs who comes with a key.
  static Messages joining(const LightEncoder& encoder, const Messages& with_key) {
    Messages all = encoder.join().value();
    all.push_back(with_key.back());
    return all;
  }
};

TEST_F(Textures, KeepBothErrorsBelowTheTargetWhatTheClientSeesIncluded) {
  Box box(exact_field());
  LightEncoder encoder = made_encoder();
  LightDecoder client = made_decoder();
  for (int update = 0; update < 12; ++update) {
    const Messages messages = encoder.encode(box.field()).value();
    test::receive_all(client, messages);
    EXPECT_EQ(messages.back().kind,
              update == 0 ? LightMessageKind::texture_key : LightMessageKind::texture);
    EXPECT_LE(encoder.errors().relative, kTarget);
    EXPECT_LE(encoder.errors().dark, kTarget);
    // What the encoder says of errors is what there is
    const LightErrors seen = test::errors_of(client, box.field());
    EXPECT_NEAR(seen.relative, encoder.errors().relative, 1e-4);
    EXPECT_NEAR(seen.dark, encoder.errors().dark, 1e-4);
    EXPECT_GT(seen.dark, 1e-3) << "it was coded";
    box.advance();
  }
}

TEST_F(Textures, TakeLateJoinersInWithTheNextKey) {
  Box box(exact_field());
  LightEncoder encoder = made_encoder();
  LightDecoder first = made_decoder(), late = made_decoder();
  test::receive_all(first, encoder.encode(box.field()).value());
  box.advance();
  test::receive_all(first, encoder.encode(box.field()).value());
  const Messages geometry = encoder.join().value();
  ASSERT_EQ(geometry.size(), 1u);
  test::receive_all(late, geometry);
  EXPECT_TRUE(late.needs_key());
  const Messages between = encoder.encode(box.field()).value();
  test::receive_all(first, between);
  EXPECT_FALSE(late.receive(between.back().bytes)) << "is no key";
  encoder.refresh();
  box.advance();
  Messages key = encoder.encode(box.field()).value();
  EXPECT_EQ(key.back().kind, LightMessageKind::texture_key);
  test::receive_all(first, key);
  test::receive_all(late, joining(encoder, key));
  EXPECT_EQ(state_of(late), state_of(first));
  box.advance();
  const Messages next = encoder.encode(box.field()).value();
  EXPECT_EQ(next.back().kind, LightMessageKind::texture);
  test::receive_all(first, next);
  test::receive_all(late, next);
  EXPECT_EQ(state_of(late), state_of(first));
}

TEST_F(Textures, BeginAnewWhereLightNoLongerFits) {
  Box box(exact_field());
  LightEncoder encoder = made_encoder();
  LightDecoder client = made_decoder();
  test::receive_all(client, encoder.encode(box.field()).value());
  for (const float factor : {100.0f, 0.0001f}) {
    box.shine(factor);
    for (int i = 0; i < 8; ++i) box.look_from(glm::vec3(0.0f));
    const Messages messages = encoder.encode(box.field()).value();
    EXPECT_EQ(messages.back().kind, LightMessageKind::texture_key);
    test::receive_all(client, messages);
    EXPECT_LE(test::errors_of(client, box.field()).dark, 1.01 * kTarget);
  }
}

TEST_F(Textures, RefuseWhatIsBrokenOrOutOfOrderUntilAKeyComes) {
  Box box(exact_field());
  LightEncoder encoder = made_encoder();
  LightDecoder client = made_decoder();
  EXPECT_FALSE(LightDecoder().receive(encoder.encode(box.field()).value().back().bytes));
  encoder.refresh();
  test::receive_all(client, joining(encoder, encoder.encode(box.field()).value()));
  EXPECT_FALSE(client.join()) << "nobody can go on from it";

  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    box.advance();
    encoder.refresh();
    std::vector<std::byte> broken = encoder.encode(box.field()).value().back().bytes;
    const std::size_t at = kMessageHeaderBytes + random() % (broken.size() - kMessageHeaderBytes);
    if (i % 2 == 0) {
      broken.resize(at);
    } else {
      broken[at] ^= static_cast<std::byte>(1u << random() % 8u);
    }
    seal_message(broken);
    // It may pass for another picture of the same size, but nothing else may come of it
    if (!client.receive(broken)) {
      EXPECT_TRUE(client.needs_key());
    }
  }
  encoder.refresh();
  test::receive_all(client, joining(encoder, encoder.encode(box.field()).value()));
  EXPECT_FALSE(client.needs_key());
  EXPECT_LE(test::errors_of(client, box.field()).dark, 1.01 * kTarget);
  encoder.encode(box.field()).value();  // is lost
  EXPECT_FALSE(client.receive(encoder.encode(box.field()).value().back().bytes));
  EXPECT_TRUE(client.needs_key());
}

TEST_F(Textures, ComeFromAServerToWhoAsksForThem) {
  const test::ServedScene served;
  Hello hello;
  hello.wants = kWantsTextures;
  Scene scene = *scenes::make("cornell-spot");
  World world(scene);
  LitScene lit(scene, world);
  lit.read_textures(make_h265_reader().value());
  auto joined = join(served.address(), hello);
  ASSERT_TRUE(joined) << joined.error().message();
  const auto end = Clock::now() + test::kPatience;
  while (lit.update() < 12 && Clock::now() < end) {
    const auto message = joined->client->receive(std::chrono::milliseconds(100));
    ASSERT_TRUE(message);
    if (!*message) continue;
    const auto followed = lit.follow(**message);
    ASSERT_TRUE(followed);
    if (followed->answer) {
      ASSERT_TRUE(joined->client->send(*followed->answer));
    }
  }
  EXPECT_GE(lit.update(), 12u);
  ASSERT_NE(lit.field(), nullptr);

  hello.wants = kWantsTextures | kWantsLight;
  EXPECT_FALSE(join(served.address(), hello));
}

TEST(WithoutH265, AServerRefusesTexturesWithTheReason) {
  if (has_h265()) GTEST_SKIP() << "built with LAMBENT_STREAM_H265";
  const test::ServedScene served;
  Hello hello;
  hello.wants = kWantsTextures;
  const auto joined = join(served.address(), hello);
  ASSERT_FALSE(joined);
  EXPECT_NE(joined.error().message().find("H.265"), std::string::npos);
}

}  // namespace
}  // namespace lambent::stream::textures_test
