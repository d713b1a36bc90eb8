// SPDX-License-Identifier: Apache-2.0
// Lights that are picked by their visibility.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "raytracing/light_visibility/learn_light_visibility.h"
#include "raytracing/shade_hits.h"
#include "raytracing/world_access.h"
#include "support/many_lights.h"

namespace lambent::light_visibility_test {
namespace {

constexpr float kEdge = 4.0f;  // of each of two rooms [m]
constexpr int kWall = 6;       // instance of the wall between them

/// Two rooms side by side along x, with a wall between them at x = 0 and a lamp under each ceiling,
/// of which that of the second room is `bright` times as bright.
Scene two_lit_rooms(float bright) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f)),
                     test::lambert(glm::vec3(0.2f), glm::vec3(1.0f)),
                     test::lambert(glm::vec3(0.2f), glm::vec3(bright))};
  test::add_room(scene, 2.0f * kEdge, 0);
  const float half = kEdge;
  test::add(scene, test::quad({0.0f, -half, -half}, {0.0f, 2.0f * half, 0.0f},
                              {0.0f, 0.0f, 2.0f * half}, 0));
  for (int room = 0; room < 2; ++room) {
    const float x = room == 0 ? -0.5f * kEdge : 0.5f * kEdge;
    test::add(scene, test::quad({x - 0.2f, 0.9f * half, -0.2f}, {0.4f, 0.0f, 0.0f},
                                {0.0f, 0.0f, 0.4f}, 1 + room));
  }
  return scene;
}

/// The floor of the first room.
LitPoint floor_point(RandomStream& random) {
  const glm::vec2 u = next_uniform2(random);
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  return {{-kEdge * (0.05f + 0.9f * u.x), -kEdge, kEdge * (1.8f * u.y - 0.9f)}, up, up};
}

struct Estimate {
  double mean = 0.0, variance = 0.0;
};

/// Direct irradiance of a point over many samples.
Estimate estimate_at(const World& world, const LitPoint& point) {
  constexpr std::size_t kSamples = 2000;
  std::vector<DirectLightQuery> queries;
  for (std::size_t i = 0; i < kSamples; ++i) queries.push_back({point, i});
  std::vector<glm::vec3> found(kSamples);
  ShadeHitsScratch scratch;
  direct_irradiance(world, queries, {}, scratch, found);
  Estimate estimate;
  for (const glm::vec3& e : found) estimate.mean += e.x / kSamples;
  for (const glm::vec3& e : found) {
    estimate.variance += (e.x - estimate.mean) * (e.x - estimate.mean) / kSamples;
  }
  return estimate;
}

LightTree& tree_of(const World& world) {
  return *WorldAccess::state_of(world).lights;
}

/// Share of the picks on the floor of the first room that go to its own lamp.
double picks_of_own_lamp(const World& world) {
  RandomStream random = make_random_stream(5u, 0u, 1u);
  constexpr int kPicks = 4000;
  int own = 0;
  for (int i = 0; i < kPicks; ++i) {
    const LitPoint point = floor_point(random);
    const LightPick pick = tree_of(world).pick(point.position_ws, point.normal_ws, no_pick_lobe(),
                                               next_uniform(random));
    if (pick.probability <= 0.0f) continue;
    if (emissive_of(world).entries()[pick.light].corner_ws.x < 0.0f) ++own;
  }
  return static_cast<double>(own) / kPicks;
}

TEST(LightVisibility, WeighsByTheRootOfWhatArrived) {
  const LightVisibilityGrid empty = LightVisibility().grid();
  EXPECT_EQ(empty.cells_per_metre, 0.0f);
  const Scene scene = test::many_lights(20);
  const World world(scene);
  const LightGroups& groups = tree_of(world).groups();
  LightVisibility visibility({glm::vec3(0.0f), glm::vec3(1.0f)}, groups);
  ASSERT_EQ(visibility.grid().row_length, kGroupsWithVisibility * kLightGroupSize);
  const glm::vec3 place(0.51f, 0.0f, 0.51f), up(0.0f, 1.0f, 0.0f);
  const std::uint32_t index = visibility_index(
      visibility.grid(), visibility_coords(visibility.grid(), place, up), facing_side(up));
  std::vector<VisibilityTest> tests;
  for (int i = 0; i < 100; ++i) {
    tests.push_back({index, 0, false});
    tests.push_back({index, 1, i < 25});
    tests.push_back({index, 9, true});
  }
  // Of the group below the first node of the root's, that node alone was tested
  ASSERT_EQ(groups.nodes()[0].link, 1u);
  visibility.add(tests);
  visibility.weigh();
  const std::uint8_t* weights = visibility.at(place, up);
  ASSERT_NE(weights, nullptr);
  EXPECT_GT(weights[0], 0);  // no light is ruled out
  EXPECT_LT(visibility_weight(weights[0]), 0.05f);
  EXPECT_NEAR(visibility_weight(weights[1]), 0.5f, 0.01f);
  EXPECT_EQ(weights[9], kWholeVisibility);
  EXPECT_EQ(weights[2], kWholeVisibility);  // not tested
  EXPECT_EQ(weights[kLightGroupSize], weights[0]);
  // Surfaces that face elsewhere, points in the air and outside of the box are not known
  EXPECT_EQ(visibility.at(place, -up), nullptr);
  EXPECT_EQ(visibility.at(place, glm::vec3(0.0f)), nullptr);
  EXPECT_EQ(visibility.at(place + glm::vec3(2.0f), up), nullptr);
  // What fades is held to be the same, but counts for less beside new tests
  for (int i = 0; i < 8; ++i) visibility.fade();
  visibility.weigh();
  EXPECT_NEAR(visibility_weight(visibility.at(place, up)[1]), 0.5f, 0.1f);
  tests.assign(100, {index, 0, true});
  visibility.add(tests);
  visibility.weigh();
  EXPECT_GT(visibility_weight(visibility.at(place, up)[0]), 0.98f);
}

TEST(LightVisibility, LampsInOtherRoomsArePickedSeldom) {
  const Scene scene = two_lit_rooms(20.0f);
  const World world(scene);
  ASSERT_FALSE(tree_of(world).visibility().empty());
  RandomStream random = make_random_stream(9u, 0u, 0u);
  std::vector<LitPoint> points(16);
  for (LitPoint& point : points) point = floor_point(random);
  std::vector<Estimate> with, without;
  const double picks = picks_of_own_lamp(world);
  for (const LitPoint& point : points) with.push_back(estimate_at(world, point));
  tree_of(world).set_visibility({});
  const double unaware = picks_of_own_lamp(world);
  for (const LitPoint& point : points) without.push_back(estimate_at(world, point));
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double error = std::sqrt((with[i].variance + without[i].variance) / 2000.0);
    EXPECT_NEAR(with[i].mean, without[i].mean, 4.0 * error);
    before += without[i].variance / (without[i].mean * without[i].mean);
    after += with[i].variance / (with[i].mean * with[i].mean);
  }
  std::printf("own lamp: %.3f of the picks, %.3f without; variance %.3f of that without\n", picks,
              unaware, after / before);
  EXPECT_GT(picks, 5.0 * unaware);
  EXPECT_LT(after, 0.2 * before);
}

TEST(LightVisibility, FollowsAWallThatIsTakenAway) {
  Scene scene = two_lit_rooms(1.0f);
  World world(scene);
  const double closed = picks_of_own_lamp(world);
  ASSERT_GT(closed, 0.9);
  // The wall goes up, out of the way, and on over many updates
  scene.instances[kWall].world_from_object[3].y = 100.0f;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(world.update());
    scene.instances[kWall].world_from_object[3].y += 1.0f;
  }
  const double opened = picks_of_own_lamp(world);
  tree_of(world).set_visibility({});
  const double unaware = picks_of_own_lamp(world);
  std::printf("own lamp: %.3f of the picks, %.3f after the wall has gone, %.3f without\n", closed,
              opened, unaware);
  EXPECT_NEAR(opened, unaware, 0.1 * unaware);
}

TEST(LightVisibility, FollowsAPointLightThatPassesAWall) {
  // More lights than every point asks, all in the first room
  Scene scene = two_lit_rooms(0.0f);
  for (int i = 0; i < 20; ++i) {
    scene.lights.push_back(
        test::point_light(glm::vec3(1.0f), {-0.3f, 2.0f - 0.1f * static_cast<float>(i), 0.0f}));
  }
  World world(scene);
  const auto picks_of_first = [&] {
    RandomStream random = make_random_stream(5u, 0u, 1u);
    double sum = 0.0;
    const auto light = static_cast<std::uint32_t>(emissive_of(world).size());
    for (int i = 0; i < 200; ++i) {
      const LitPoint point = floor_point(random);
      sum += tree_of(world).probability(light, point.position_ws, point.normal_ws, no_pick_lobe());
    }
    return sum / 200.0;
  };
  ASSERT_FALSE(tree_of(world).visibility().empty());
  const double beside = picks_of_first();
  const int builds = tree_of(world).builds();
  for (int i = 0; i < 100; ++i) {
    scene.lights[0].position_ws = {0.3f, 2.0f + 0.001f * static_cast<float>(i), 0.0f};
    ASSERT_TRUE(world.update());
  }
  const double behind = picks_of_first();
  ASSERT_EQ(tree_of(world).builds(), builds);
  std::printf("a light: %.4f of the picks, %.4f behind a wall\n", beside, behind);
  EXPECT_LT(behind, 0.6 * beside);
}

TEST(LightVisibility, IsLearnedAgainWithOtherLights) {
  Scene scene = two_lit_rooms(20.0f);
  World world(scene);
  const int builds = tree_of(world).builds();
  test::add(scene, test::quad({-3.0f, -3.0f, -3.0f}, {0.1f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.1f}, 1));
  ASSERT_TRUE(world.update());
  ASSERT_GT(tree_of(world).builds(), builds);
  const double picks = picks_of_own_lamp(world);
  tree_of(world).set_visibility({});
  EXPECT_GT(picks, 2.0 * picks_of_own_lamp(world));
}

TEST(LightVisibility, IsEmptyWhereThereIsNothingToChoose) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  test::add_room(scene, kEdge, 0);
  EXPECT_TRUE(learn_light_visibility(World(scene)).empty());
  scene.lights = {test::point_light(glm::vec3(1.0f), glm::vec3(0.0f))};
  EXPECT_TRUE(learn_light_visibility(World(scene)).empty());
  // Many lights at one place have a table, and those of no scene none
  scene.lights.assign(20,
                      test::point_light(glm::vec3(1.0f), glm::vec3(0.0f, -0.49f * kEdge, 0.0f)));
  EXPECT_FALSE(learn_light_visibility(World(scene)).empty());
  scene.instances.clear();
  EXPECT_TRUE(learn_light_visibility(World(scene)).empty());
}

TEST(LightVisibility, IsTheSameInEveryRun) {
  const Scene scene = test::many_lights(20);
  const World world(scene);
  const LightVisibility again = learn_light_visibility(world);
  EXPECT_EQ(again.rows(), tree_of(world).visibility().rows());
  EXPECT_EQ(again.weights(), tree_of(world).visibility().weights());
}

}  // namespace
}  // namespace lambent::light_visibility_test
