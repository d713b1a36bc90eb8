// SPDX-License-Identifier: Apache-2.0
// Fields of several volumes: which there are, what each has to say, and how they follow the viewer.
#include "field/probes/volumes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "field/lookup/lookup_volumes.h"
#include "support/field_scenes.h"
#include "support/random_store.h"

namespace lambent::volumes_test {
namespace {

using testing::HasSubstr;

const Bounds kRoom{{-3.0f, 0.0f, -2.0f}, {3.0f, 3.0f, 2.0f}};

mat3 turned(float radians) {
  return {{std::cos(radians), 0.0f, -std::sin(radians)},
          {0.0f, 1.0f, 0.0f},
          {std::sin(radians), 0.0f, std::cos(radians)}};
}

ProbeVolume small_volume(const vec3& centre, float radians, int priority, float spacing) {
  ProbeVolume volume;
  volume.centre = centre;
  volume.size = {1.6f, 1.2f, 1.4f};
  volume.axes = turned(radians);
  volume.probe_spacing = spacing;
  volume.priority = priority;
  return volume;
}

/// Three volumes that overlap, two of them turned, within a fourth.
FieldSettings overlapping() {
  FieldSettings settings = test::exact_formats();
  settings.probe_count = {5, 4, 5};
  settings.volumes = {small_volume({0.0f, 1.0f, 0.0f}, 0.4f, 0, 0.4f),
                      small_volume({0.7f, 1.2f, 0.3f}, -0.9f, 0, 0.3f),
                      small_volume({-0.5f, 0.8f, 0.2f}, 0.0f, 5, 0.5f)};
  return settings;
}

std::vector<ProbeGrid> grids_of(const FieldSettings& settings) {
  std::vector<ProbeGrid> grids;
  const std::vector<Volume> volumes = plan_volumes(settings, kRoom).value();
  for (const Volume& volume : volumes) grids.push_back(volume.grid);
  return grids;
}

std::vector<FieldQuery> random_queries(int count) {
  RandomStream random = make_random_stream(7, 8, 9);
  std::vector<FieldQuery> queries(count);
  for (FieldQuery& query : queries) {
    const vec3 u(next_uniform2(random), next_uniform(random));
    query = {mix(kRoom.min - 0.5f, kRoom.max + 0.5f, u), test::random_unit(random),
             test::random_unit(random)};
  }
  return queries;
}

/// Volumes as a viewer who has walked about leaves them.
std::vector<ProbeGrid> scrolled_grids() {
  FieldSettings settings;
  settings.cascades = 3;
  settings.probe_count = {6, 4, 5};
  settings.probe_spacing = 0.4f;
  std::vector<ProbeGrid> grids = grids_of(settings);
  for (const vec3& viewer : {vec3(1.0f, 1.0f, 1.0f), vec3(-0.7f, 1.9f, 0.8f)}) {
    for (ProbeGrid& grid : grids) grid = scrolled(grid, viewer);
  }
  return grids;
}

TEST(Volumes, AreAskedByPriorityThenFinestFirst) {
  const std::vector<ProbeGrid> grids = grids_of(overlapping());
  ASSERT_EQ(grids.size(), 4u);
  EXPECT_NEAR(grids[0].spacing.x, 0.4f, 1e-3f);  // priority 5: 4 cells of at most 0.5 m
  EXPECT_LT(smallest_spacing(grids[1]), smallest_spacing(grids[2]));
  EXPECT_EQ(grids[3].count, ivec3(5, 4, 5));
}

TEST(Volumes, AreAPartitionOfUnity) {
  for (const std::vector<ProbeGrid>& grids : {grids_of(overlapping()), scrolled_grids()}) {
    ProbeStore store(grids, test::exact_formats());
    test::fill_randomly(store);
    const std::vector<FieldQuery> queries = random_queries(2000);
    QueryWeights weights;
    find_weights(store, {}, queries, weights);
    std::vector<float> sums(queries.size(), 0.0f);
    int shared = 0;
    for (std::size_t i = 0; i < weights.corners.size(); ++i) {
      for (const float weight : weights.corners[i].weight) {
        EXPECT_GE(weight, 0.0f);
        sums[weights.query[i]] += weight;
      }
      shared += i >= queries.size() ? 1 : 0;
    }
    for (const float sum : sums) EXPECT_NEAR(sum, 1.0f, 1e-5f);
    EXPECT_GT(shared, 40);  // many points lie where volumes blend
  }
}

TEST(Volumes, OfConstantLightAreThatLightEverywhere) {
  ProbeStore store(grids_of(overlapping()), test::exact_formats());
  test::fill_randomly(store);
  const std::vector<vec3> light(16, vec3(0.75f));
  for (int probe = 0; probe < store.probes(); ++probe) store.store_irradiance(probe, light, 0u);
  const std::vector<FieldQuery> queries = random_queries(300);
  std::vector<vec3> result(queries.size());
  lookup_irradiance(store, {}, queries, result);
  for (const vec3& e : result) EXPECT_LT(glm::distance(e, vec3(0.75f)), 1e-5f);
}

TEST(Volumes, AreLookedUpAsTheSharedLookupDoes) {
  for (const std::vector<ProbeGrid>& grids : {grids_of(overlapping()), scrolled_grids()}) {
    ProbeStore store(grids, test::exact_formats());
    test::fill_randomly(store);
    test::SharedLookup shared{store};
    const std::vector<FieldQuery> queries = random_queries(700);
    std::vector<vec3> result(queries.size());
    lookup_irradiance(store, {}, queries, result);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const FieldQuery& q = queries[i];
      const vec3 expected = shared.lookup_irradiance(store.volumes(), q.position_ws, q.normal_ws,
                                                     q.to_viewer_ws, q.viewer_distance);
      EXPECT_LT(glm::distance(result[i], expected), 3e-4f * glm::length(expected)) << i;
    }
  }
}

TEST(Volumes, ThatKnowNothingLeaveItToOthers) {
  FieldSettings settings = overlapping();
  ProbeStore store(grids_of(settings), settings);
  const std::vector<vec2> far(
      static_cast<std::size_t>(settings.distance_texels) * settings.distance_texels,
      vec2(100.0f, 10000.0f));
  const std::vector<vec3> light(16, vec3(2.0f));
  // Only the second one has seen anything
  const std::vector<FieldQuery> queries = {
      {grid_position(store.grid(1), 0.5f * vec3(store.grid(1).count - 1)), {0, 1, 0}, {0, 1, 0}}};
  std::vector<vec3> result(1);
  lookup_irradiance(store, {}, queries, result);
  EXPECT_EQ(result[0], vec3(0.0f));
  for (int i = 0; i < probe_count(store.grid(1)); ++i) {
    store.store_irradiance(store.grid(1).first + i, light, 0u);
    store.blend_moments(store.grid(1).first + i, far, 1.0f, 0u);
  }
  lookup_irradiance(store, {}, queries, result);
  EXPECT_LT(glm::distance(result[0], vec3(2.0f)), 1e-5f);
}

TEST(Volumes, ShareFadesWithoutAStep) {
  const ProbeGrid grid = still_grid({vec3(-1.0f), vec3(0.5f), ivec3(5), turned(0.3f)});
  const vec3 middle = grid_position(grid, vec3(2.0f));
  EXPECT_EQ(volume_blend_weight(grid, middle), 1.0f);
  EXPECT_EQ(volume_blend_weight(grid, grid_position(grid, vec3(4.0f, 2.0f, 2.0f))), 1.0f);
  EXPECT_EQ(volume_blend_weight(grid, grid_position(grid, vec3(5.0f, 2.0f, 2.0f))), 0.0f);
  float before = 1.0f;
  for (int i = 0; i <= 100; ++i) {
    const float share = volume_blend_weight(
        grid, grid_position(grid, vec3(4.0f + 0.01f * static_cast<float>(i), 2, 2)));
    EXPECT_LE(share, before);
    EXPECT_GT(share, before - 0.011f);
    before = share;
  }
}

class ScrollDirection : public testing::TestWithParam<ivec3> {};

TEST_P(ScrollDirection, KeepsProbesWhereTheyAreAndRecyclesOneSlab) {
  FieldSettings settings;
  settings.cascades = 1;
  settings.probe_count = {9, 4, 5};  // long and short axes
  settings.probe_spacing = 0.5f;
  // In the very middle of a volume
  const vec3 start(1.0f, 0.75f, 1.0f);
  ProbeGrid grid = centred(plan_volumes(settings, kRoom)->front().grid, start);
  // Once round memory and on
  for (int step = 1; step <= 8; ++step) {
    const vec3 viewer = start + 0.5f * static_cast<float>(step) * vec3(GetParam());
    // Along short axes slabs withdraw before they go
    ProbeGrid next = scrolled(grid, viewer);
    constexpr int kMaxUpdateCount = 100;
    for (int i = 0; i < kMaxUpdateCount && recycled_probes(grid, next).empty(); ++i) {
      grid = next;
      next = scrolled(grid, viewer);
    }
    const std::vector<int> recycled = recycled_probes(grid, next);
    const ivec3 moved = abs(GetParam());
    const int slab = probe_count(grid) / (moved.x * 9 + moved.y * 4 + moved.z * 5);
    EXPECT_EQ(recycled.size(), static_cast<std::size_t>(slab));
    std::set<int> all;
    for (int probe = 0; probe < probe_count(next); ++probe) {
      const ivec3 coords = probe_coords(next, probe);
      EXPECT_EQ(probe_index(next, coords), probe);
      all.insert(probe_index(next, coords));
      const bool new_place = std::binary_search(recycled.begin(), recycled.end(), probe);
      const float away = glm::distance(probe_position(grid, probe_coords(grid, probe)),
                                       probe_position(next, coords));
      if (new_place) {
        EXPECT_GT(away, 1.4f);
      } else {
        EXPECT_LT(away, 1e-4f);
      }
      // Nobody asks a probe that has just come or was about to go
      const float share = volume_blend_weight(next, probe_position(next, coords));
      EXPECT_TRUE(!new_place || share == 0.0f);
      const float left = volume_blend_weight(grid, probe_position(grid, probe_coords(grid, probe)));
      EXPECT_TRUE(!new_place || left == 0.0f);
    }
    EXPECT_EQ(all.size(), static_cast<std::size_t>(probe_count(next)));
    grid = next;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryWay, ScrollDirection,
                         testing::Values(ivec3(1, 0, 0), ivec3(-1, 0, 0), ivec3(0, 1, 0),
                                         ivec3(0, -1, 0), ivec3(0, 0, 1), ivec3(0, 0, -1)));

TEST(Volumes, DoNotFollowWhoMovesToAndFro) {
  FieldSettings settings;
  settings.cascades = 1;
  ProbeGrid grid = scrolled(plan_volumes(settings, kRoom)->front().grid, vec3(0.5f));
  for (const float x : {1.1f, -0.1f, 1.2f, 0.0f}) {
    const ProbeGrid next = scrolled(grid, {x, 0.5f, 0.5f});
    EXPECT_TRUE(recycled_probes(grid, next).empty());
    grid = next;
  }
  EXPECT_FALSE(recycled_probes(grid, scrolled(grid, vec3(3.0f, 0.5f, 0.5f))).empty());
  // Who is carried away sees nothing of what was there
  EXPECT_EQ(recycled_probes(grid, scrolled(grid, vec3(500.0f))).size(), 32u * 4u * 32u);
}

std::string refusal(const FieldSettings& settings) {
  const auto planned = plan_volumes(settings, kRoom);
  return planned ? "" : planned.error().message();
}

TEST(Volumes, ThatMakeNoSenseAreRefused) {
  FieldSettings settings;
  settings.cascades = 17;
  EXPECT_THAT(refusal(settings), HasSubstr("cascades"));
  settings.cascades = -1;
  EXPECT_THAT(refusal(settings), HasSubstr("cascades"));
  settings.cascades = 2;
  settings.volume = kRoom;
  EXPECT_THAT(refusal(settings), HasSubstr("follow the viewer"));
  settings.volume = {};
  settings.probe_count = {8, 3, 8};
  EXPECT_THAT(refusal(settings), HasSubstr("at least 4"));
  settings.probe_count = {100, 100, 100};
  EXPECT_THAT(refusal(settings), HasSubstr("1,048,576"));
  settings.probe_count = ivec3(0);
  settings.probe_spacing = NAN;
  EXPECT_THAT(refusal(settings), HasSubstr("spacing"));

  const auto refused = [](auto edit) {
    FieldSettings one;
    one.volumes = {small_volume({0, 1, 0}, 0.2f, 0, 0.5f)};
    one.volumes[0].name = "nook";
    edit(one.volumes[0]);
    return refusal(one);
  };
  EXPECT_EQ(refused([](ProbeVolume&) {}), "");
  EXPECT_THAT(refused([](ProbeVolume& v) { v.centre.x = 99.0f; }), HasSubstr("'nook'"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.centre.x = 99.0f; }), HasSubstr("outside"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.size.y = NAN; }), HasSubstr("within 0 to 1e9 m"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.size.y = -1.0f; }), HasSubstr("nook"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.axes[0] *= 2.0f; }), HasSubstr("rotation"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.axes[1] = v.axes[0]; }), HasSubstr("rotation"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.probe_spacing = -1.0f; }), HasSubstr("spacing"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.probe_spacing = 1e-4f; }), HasSubstr("1,048,576"));
  EXPECT_THAT(refused([](ProbeVolume& v) { v.probe_count = {1, 2, 2}; }), HasSubstr("nook"));
}

}  // namespace
}  // namespace lambent::volumes_test
