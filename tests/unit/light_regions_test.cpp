// SPDX-License-Identifier: Apache-2.0
// Light by regions: near ones with each update, the others every eighth.
#include <gtest/gtest.h>

#include <random>

#include "stream/light/message.h"
#include "stream/regions/region_encoder.h"
#include "support/light_box.h"

namespace lambent::stream::light_regions_test {
namespace {

using test::Box;
using test::encoded;
using test::made_encoder;
using test::Messages;
using test::receive_all;
using test::state_of;

/// A field of some regions in the box, which is 5.5 m wide.
FieldSettings many_probes() {
  FieldSettings settings = test::exact_field();
  settings.probe_count = {34, 4, 4};
  return settings;
}

/// A server whose clients get regions.
class Regional {
 public:
  /// Codes the next light.
  void advance() {
    messages = encoded(encoder, box);
    receive_all(whole, messages);
    anew = regions.follow(whole);
    box.advance();
  }
  /// What a client is sent of it.
  Messages update_for(const Surroundings& client, bool all, FollowedRegions& has) {
    Messages to = all ? encoder.join().value() : messages;
    to.pop_back();
    to.push_back(regions.update_for(whole, client, all || anew, has));
    return to;
  }

  Box box{many_probes()};
  LightEncoder encoder = made_encoder();
  LightDecoder whole;
  RegionEncoder regions;
  Messages messages;
  bool anew = false;
};

Surroundings everything() {
  return {glm::vec3(0.0f), glm::vec3(0.0f, 0.0f, 1.0f), 1.0f, 1e6f};
}
/// At an end of the box, with its back to the rest.
Surroundings at_the_end() {
  return {glm::vec3(-0.5f, 2.5f, 2.7f), glm::vec3(-1.0f, 0.0f, 0.0f), 0.5f, 1.0f};
}

std::vector<glm::vec3> light_of(const LightDecoder& decoder) {
  return state_of(decoder).light;
}

TEST(LightRegions, WhoIsNearAllHasTheWholeStreamToTheBit) {
  Regional server;
  LightDecoder client;
  FollowedRegions has;
  for (int update = 0; update < 12; ++update) {
    server.advance();
    receive_all(client, server.update_for(everything(), update == 0, has));
    ASSERT_EQ(state_of(client), state_of(server.whole)) << update;
    EXPECT_FALSE(client.needs_key());
  }
  EXPECT_FALSE(client.join()) << "regions lead to no stream that is whole";
}

TEST(LightRegions, FarOnesAreExactAsOfTheirTurn) {
  Regional server;
  LightDecoder client;
  FollowedRegions has;
  std::vector<std::vector<glm::vec3>> truth;
  std::size_t stale = 0, fresh = 0;
  const int texels = 4 * 4;
  for (int update = 1; update <= 12; ++update) {
    server.advance();
    truth.push_back(light_of(server.whole));
    receive_all(client, server.update_for(at_the_end(), update == 1, has));
    const std::vector<glm::vec3> here = light_of(client);
    const RegionCut cut(geometry_of(server.box.field()),
                        layout_of(geometry_of(server.box.field())));
    ASSERT_EQ(cut.size(), has.size());
    for (std::size_t r = 0; r < cut.size(); ++r) {
      std::size_t turn = static_cast<std::size_t>(update);
      while (has[r] == RegionRate::far && turn > 1 && !has_its_turn(r, turn)) --turn;
      for (const int probe : cut.regions()[r].probes) {
        for (int t = 0; t < texels; ++t) {
          const std::size_t at = static_cast<std::size_t>(probe) * texels + t;
          ASSERT_EQ(here[at], truth[turn - 1][at]) << "region " << r << ", update " << update;
        }
      }
      ++(turn == static_cast<std::size_t>(update) ? fresh : stale);
    }
  }
  EXPECT_GT(stale, fresh / 4);
  EXPECT_GT(fresh, 0u);
}

TEST(LightRegions, OneEncodeServesAllWhoAreSomewhereElse) {
  Regional server;
  LightDecoder near, far, mover;
  FollowedRegions of_near, of_far, of_mover;
  for (int update = 0; update < 26; ++update) {
    server.advance();
    receive_all(near, server.update_for(everything(), update == 0, of_near));
    receive_all(far, server.update_for(at_the_end(), update == 0, of_far));
    // Comes late, and goes to and fro
    if (update < 5) continue;
    const bool near_all = update % 13 < 6;
    receive_all(mover,
                server.update_for(near_all ? everything() : at_the_end(), update == 5, of_mover));
    ASSERT_EQ(state_of(near), state_of(server.whole));
    if (near_all) {
      ASSERT_EQ(light_of(mover), light_of(server.whole)) << update;
    }
  }
  EXPECT_FALSE(far.needs_key());
}

TEST(LightRegions, TakeFewerBytesWhereLessIsNear) {
  Regional server;
  LightDecoder near, far;
  FollowedRegions of_near, of_far;
  std::size_t all_bytes = 0, few_bytes = 0, whole_bytes = 0;
  for (int update = 0; update < 12; ++update) {
    server.advance();
    const Messages all = server.update_for(everything(), update == 0, of_near);
    const Messages few = server.update_for(at_the_end(), update == 0, of_far);
    receive_all(near, all);
    receive_all(far, few);
    if (update == 0) continue;
    all_bytes += all.back().bytes.size();
    few_bytes += few.back().bytes.size();
    whole_bytes += server.messages.back().bytes.size();
  }
  EXPECT_LT(few_bytes, all_bytes);
  EXPECT_LT(all_bytes, 2 * whole_bytes) << "models of regions learn what those of the whole do";
}

TEST(LightRegions, WhatIsLostOrBrokenIsAskedForAgain) {
  Regional server;
  LightDecoder client;
  FollowedRegions has;
  server.advance();
  receive_all(client, server.update_for(at_the_end(), true, has));
  server.advance();
  server.update_for(at_the_end(), false, has);  // is lost
  server.advance();
  const Messages next = server.update_for(at_the_end(), false, has);
  EXPECT_FALSE(client.receive(next.back().bytes));
  EXPECT_TRUE(client.needs_key());
  receive_all(client, server.update_for(at_the_end(), true, has));
  EXPECT_FALSE(client.needs_key());
  // A change of the whole stream does not follow on regions
  server.advance();
  EXPECT_FALSE(client.receive(server.messages.back().bytes));
  EXPECT_TRUE(client.needs_key());

  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i) {
    receive_all(client, server.update_for(at_the_end(), true, has));
    server.advance();
    const std::vector<glm::vec3> before = light_of(client);
    std::vector<std::byte> broken = server.update_for(at_the_end(), false, has).back().bytes;
    const std::size_t at = kMessageHeaderBytes + random() % (broken.size() - kMessageHeaderBytes);
    if (i % 2 == 0) {
      broken.resize(at);
    } else {
      broken[at] ^= static_cast<std::byte>(1u << random() % 8u);
    }
    seal_message(broken);
    if (client.receive(broken)) continue;
    EXPECT_EQ(light_of(client), before);
    EXPECT_TRUE(client.needs_key());
  }
}

TEST(LightRegions, CascadesAreAlwaysNear) {
  FieldSettings settings = test::exact_field();
  settings.cascades = 2;
  settings.probe_count = glm::ivec3(8);
  settings.probe_spacing = 0.8f;
  Box box(settings);
  const FieldGeometry geometry = geometry_of(box.field());
  const RegionCut cut(geometry, layout_of(geometry));
  Surroundings away = at_the_end();
  away.position_ws = glm::vec3(1000.0f);
  for (const Region& region : cut.regions()) {
    EXPECT_EQ(is_near(away, region, geometry), geometry.volumes[region.volume].role.follows_viewer);
  }
}

}  // namespace
}  // namespace lambent::stream::light_regions_test
