// SPDX-License-Identifier: Apache-2.0
// What who comes late gets: geometry in parts, and corrections when there is room for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "stream/light/message.h"
#include "support/light_box.h"

namespace lambent::stream::light_join_test {
namespace {

using test::Box;
using test::encoded;
using test::made_encoder;
using test::Messages;
using test::receive_all;
using test::state_of;
using ::testing::HasSubstr;

/// More probes than one part has.
FieldSettings large_field(int edge = 9) {
  FieldSettings settings = Box::small_field();
  settings.probe_count = glm::ivec3(edge);
  return settings;
}

FieldSettings corrected_field() {
  FieldSettings settings = Box::small_field();
  settings.corrections = true;
  return settings;
}

std::vector<std::vector<std::byte>> bytes_of(const Messages& messages) {
  std::vector<std::vector<std::byte>> bytes;
  for (const LightMessage& message : messages) bytes.push_back(message.bytes);
  return bytes;
}

TEST(LightJoin, TakesPartsOfGeometryInAnyOrder) {
  Box box(large_field());
  LightEncoder encoder = made_encoder();
  Messages messages = encoded(encoder, box);
  ASSERT_EQ(messages.size(), 3u);
  LightDecoder ordered, client;
  receive_all(ordered, messages);
  std::swap(messages[0], messages[1]);
  ASSERT_TRUE(client.receive(messages[0].bytes));
  EXPECT_EQ(client.geometry(), 0u) << "not all of it is there";
  const auto early = client.receive(messages[2].bytes);
  ASSERT_FALSE(early);
  EXPECT_THAT(early.error().message(), HasSubstr("geometry"));
  ASSERT_TRUE(client.receive(messages[0].bytes)) << "twice the same";
  receive_all(client, {messages[1], messages[2]});
  EXPECT_FALSE(client.needs_key());
  EXPECT_EQ(state_of(client), state_of(ordered));
  // One that comes once more changes nothing
  EXPECT_FALSE(client.changed().empty());
  ASSERT_TRUE(client.receive(messages[0].bytes));
  EXPECT_TRUE(client.changed().empty());
  EXPECT_EQ(state_of(client), state_of(ordered));
}

TEST(LightJoin, RefusesAPartOfAnotherGeometry) {
  // Of the same stream and update, as no two encoders of a server are
  Box box(large_field()), other_box(large_field(10));
  LightEncoder encoder = made_encoder(), other = made_encoder();
  const Messages messages = encoded(encoder, box), others = encoded(other, other_box);
  LightDecoder client;
  ASSERT_TRUE(client.receive(messages[0].bytes));
  const auto refused = client.receive(others[1].bytes);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("another one than it began"));
  receive_all(client, {messages[1], messages[2]});
  EXPECT_EQ(client.probes(), 729);
}

TEST(LightJoin, GivesWhatHasChangedSinceItWasCodedLast) {
  Box box(large_field());
  // Some distances are sent again in each update, those of other probes never
  LightEncoder encoder = made_encoder({.distance_threshold = 0.05f});
  LightDecoder relay;
  receive_all(relay, encoded(encoder, box));
  for (int update = 0; update < 6; ++update) {
    box.look_from(glm::vec3(0.0f));
    receive_all(relay, encoded(encoder, box));
    LightDecoder late;
    receive_all(late, encoder.join().value());
    EXPECT_EQ(state_of(late), state_of(relay));
    // Of these two the second has coded nothing before
    EXPECT_EQ(bytes_of(relay.join().value()), bytes_of(encoder.join().value()));
    EXPECT_EQ(bytes_of(late.join().value()), bytes_of(encoder.join().value()));
  }
}

TEST(LightJoin, BringsCorrectionsLater) {
  Box box(corrected_field());
  LightEncoder encoder = made_encoder();
  EXPECT_TRUE(encoder.corrections().empty());
  LightDecoder client;
  receive_all(client, encoded(encoder, box));
  const Messages pieces = encoder.corrections();
  ASSERT_FALSE(pieces.empty());
  EXPECT_FALSE(client.has_corrections());
  EXPECT_TRUE(client.corrections().empty()) << "there is nothing yet to hand on";
  // Light goes on without them
  box.advance();
  receive_all(client, encoded(encoder, box));
  const auto before = state_of(client);
  receive_all(client, pieces);
  EXPECT_TRUE(client.has_corrections());
  EXPECT_EQ(state_of(client), before);
  EXPECT_EQ(client.corrections_number(), encoder.corrections_number());
  EXPECT_EQ(bytes_of(client.corrections()), bytes_of(encoder.corrections()));
  // Of who gets all of the geometry again, these are still the same
  receive_all(client, encoder.join().value());
  EXPECT_TRUE(client.has_corrections());
}

TEST(LightJoin, RefusesCorrectionsOfWhatIsNotThere) {
  Box box(corrected_field());
  LightEncoder encoder = made_encoder();
  const Messages first = encoded(encoder, box);
  const Messages old = encoder.corrections();
  LightDecoder client;
  EXPECT_FALSE(client.receive(old.front().bytes)) << "there is no geometry";
  receive_all(client, first);
  while (encoder.corrections_number() == client.corrections_number()) {
    box.advance();
    encoded(encoder, box);
  }
  receive_all(client, encoder.join().value());
  const auto refused = client.receive(old.front().bytes);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("not here"));
  EXPECT_FALSE(client.needs_key()) << "the light is as good as before";
  EXPECT_FALSE(client.has_corrections());
  std::vector<std::byte> broken = encoder.corrections().front().bytes;
  broken.resize(broken.size() - 9);
  seal_message(broken);
  EXPECT_FALSE(client.receive(broken));
  EXPECT_FALSE(client.needs_key());
  EXPECT_FALSE(client.has_corrections());
}

}  // namespace
}  // namespace lambent::stream::light_join_test
