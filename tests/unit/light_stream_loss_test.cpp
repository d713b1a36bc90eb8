// SPDX-License-Identifier: Apache-2.0
// Clients that come late, lose messages or get broken ones have what the server coded, or nothing
// new.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "stream/light/message.h"
#include "support/light_box.h"

namespace lambent::stream::light_stream_loss_test {
namespace {

using test::Box;
using test::Decoded;
using test::encoded;
using test::made_encoder;
using test::Messages;
using test::receive_all;
using test::state_of;
using ::testing::HasSubstr;

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

TEST(LightStream, WhoeverFollowsItCanTakeOthersIn) {
  Box box;
  LightEncoder encoder = made_encoder();
  LightDecoder relay;
  EXPECT_FALSE(relay.join()) << "there is nothing yet";
  for (int update = 0; update < 6; ++update) {
    receive_all(relay, encoded(encoder, box));
    for (const std::uint64_t known : {std::uint64_t{0}, relay.geometry()}) {
      const Messages theirs = encoder.join(known).value(), ours = relay.join(known).value();
      ASSERT_EQ(ours.size(), theirs.size());
      for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_EQ(ours[i].bytes, theirs[i].bytes);
    }
    box.advance();
  }
  encoded(encoder, box);  // is lost
  EXPECT_FALSE(relay.receive(encoded(encoder, box).back().bytes));
  EXPECT_FALSE(relay.join()) << "what it has leads nowhere";
}

TEST(LightStream, RefusesWhatFollowsOnALossUntilAKeyComes) {
  Box box;
  // Geometry stays as it is, so that it is updates that tell
  LightEncoder encoder = made_encoder({.distance_threshold = 1.0f});
  LightDecoder whole, lossy;
  for (int update = 0; update < 3; ++update) {
    const Messages messages = encoded(encoder, box);
    receive_all(whole, messages);
    receive_all(lossy, messages);
    box.advance();
  }
  const Messages lost = encoded(encoder, box);
  EXPECT_EQ(lost.size(), 1u);
  receive_all(whole, lost);
  box.advance();
  const Decoded before = state_of(lossy);
  for (int update = 0; update < 3; ++update) {
    const Messages messages = encoded(encoder, box);
    receive_all(whole, messages);
    for (const LightMessage& message : messages) {
      const Expected<void> refused = lossy.receive(message.bytes);
      ASSERT_FALSE(refused);
      EXPECT_THAT(refused.error().message(), HasSubstr("was lost"));
    }
    EXPECT_TRUE(lossy.needs_key());
    EXPECT_EQ(state_of(lossy), before);
    box.advance();
  }
  // Geometry is not sent to those who have it
  const Messages key = encoder.join(lossy.geometry()).value();
  ASSERT_EQ(key.size(), 1u);
  EXPECT_EQ(key.back().kind, LightMessageKind::key);
  receive_all(lossy, key);
  EXPECT_FALSE(lossy.needs_key());
  EXPECT_EQ(state_of(lossy), state_of(whole));
  const Messages next = encoded(encoder, box);
  receive_all(whole, next);
  receive_all(lossy, next);
  EXPECT_EQ(state_of(lossy), state_of(whole));
}

TEST(LightStream, RefusesLightOfGeometryThatWasLost) {
  Box box;
  LightEncoder encoder = made_encoder({.distance_threshold = 0.001f});
  LightDecoder client;
  receive_all(client, encoded(encoder, box));
  box.advance();
  const Messages messages = encoded(encoder, box);
  ASSERT_EQ(messages.front().kind, LightMessageKind::geometry);
  const Expected<void> refused = client.receive(messages.back().bytes);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("geometry"));
  EXPECT_TRUE(client.needs_key());
  receive_all(client, encoder.join(client.geometry()).value());
  EXPECT_FALSE(client.needs_key());
  EXPECT_EQ(client.update(), 2u);
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

}  // namespace
}  // namespace lambent::stream::light_stream_loss_test
