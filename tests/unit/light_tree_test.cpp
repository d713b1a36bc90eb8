// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include "raytracing/shade_hits.h"
#include "scene/light_tree/pick_lobe.h"
#include "shared/constants.h"
#include "support/chi_squared.h"
#include "support/many_lights.h"

namespace lambent::light_tree_test {
namespace {

using test::many_lights;

// What light_tree.inl.h requires: the loop over the single nodes of groups.
using LightTreeRef = const LightGroups&;
uint light_tree_size(const LightGroups& groups) {
  return static_cast<uint>(groups.nodes().size());
}
uint fetch_group_link(const LightGroups& groups, uint group, uint child) {
  return groups.nodes()[group * kLightGroupSize + child].link;
}
void group_importances(const LightGroups& groups, uint group, const vec3& position_ws,
                       const vec3& normal_ws, const PickLobe& lobe, float* importances) {
  for (uint k = 0; k < kLightGroupSize; ++k) {
    importances[k] =
        light_importance(groups.nodes()[group * kLightGroupSize + k], position_ws, normal_ws, lobe);
  }
}
bool knows_visibility(const LightGroups& /*groups*/, uint /*group*/) {
  return false;
}
float fetch_visibility(const LightGroups& /*groups*/, uint /*group*/, uint /*child*/) {
  return 1.0f;
}

#include "scene/light_tree/light_tree.inl.h"

struct Lights {
  explicit Lights(const Scene& scene) : emissive(scene), tree(scene, emissive) {}
  void update(const Scene& scene) {
    emissive = EmissiveTriangles(scene);
    tree.update(scene, emissive);
  }
  /// Of the tree, as it numbers them; some are none of its lights.
  std::uint32_t count() const {
    return static_cast<std::uint32_t>(emissive.size() + tree.lights().size());
  }
  EmissiveTriangles emissive;
  LightTree tree;
};

/// A point that asks for light, in the room or far outside.
LitPoint random_point(RandomStream& random) {
  glm::vec3 place = test::place_in_room(random);
  if (next_uniform(random) < 0.2f) place *= 5.0f;
  const glm::vec3 normal = sample_uniform_sphere(next_uniform2(random));
  return {place, normal, normal};
}

/// The lobe of a shiny coat over a darker base, seen from somewhere above the surface.
PickLobe shiny_lobe(const glm::vec3& normal_ws, RandomStream& random) {
  const Reflectance surface{glm::vec3(0.2f), 0.05f, glm::vec3(0.04f), 1.0f, no_layers(), 1.0f};
  const Frame frame = make_frame(normal_ws);
  const glm::vec3 drawn = sample_cosine_hemisphere(next_uniform2(random));
  return pick_lobe(surface, frame, drawn);
}

/// Whether the lights of the tree have probabilities that sum up to 1, less than that of no pick.
void expect_picks_by_probability(const Lights& lights, const LitPoint& point,
                                 const PickLobe& lobe) {
  constexpr int kSamples = 60000;
  std::vector<double> observed(lights.count()), expected(lights.count());
  double sum = 0.0;
  for (const std::uint32_t asked : lights.tree.asked())
    expected[lights.emissive.size() + asked] = 0;
  std::vector<std::uint8_t> asked(lights.count(), 0);
  for (const std::uint32_t a : lights.tree.asked()) asked[lights.emissive.size() + a] = 1;
  for (std::uint32_t i = 0; i < lights.count(); ++i) {
    if (asked[i] != 0) continue;
    const double probability = lights.tree.probability(i, point.position_ws, point.normal_ws, lobe);
    expected[i] = kSamples * probability;
    sum += probability;
  }
  ASSERT_LT(sum, 1.0 + 1e-4);
  std::vector<double> rests(16), even(16, 0.0);
  int none = 0;
  for (int i = 0; i < kSamples; ++i) {
    RandomStream random = make_random_stream(static_cast<std::uint32_t>(i), 1u, 2u);
    const LightPick pick =
        lights.tree.pick(point.position_ws, point.normal_ws, lobe, next_uniform(random));
    if (pick.probability <= 0.0f) {
      ++none;
      continue;
    }
    observed[pick.light] += 1.0;
    ASSERT_NEAR(pick.probability, expected[pick.light] / kSamples, 1e-4 * pick.probability);
    ASSERT_GE(pick.rest, 0.0f);
    ASSERT_LT(pick.rest, 1.0f);
    rests[static_cast<std::size_t>(pick.rest * 16.0f)] += 1.0;
  }
  EXPECT_NEAR(static_cast<double>(none) / kSamples, 1.0 - sum, 0.01);
  if (none > kSamples / 2) return;  // too few are left to be tested
  std::fill(even.begin(), even.end(), (kSamples - none) / 16.0);
  EXPECT_LT(test::chi_squared_deviation(observed, expected), test::kMaxChiSquaredDeviation);
  EXPECT_LT(test::chi_squared_deviation(rests, even), test::kMaxChiSquaredDeviation);
}

TEST(LightTree, PicksLightsByTheirProbability) {
  const Scene scene = many_lights(40);
  const Lights lights(scene);
  ASSERT_EQ(lights.tree.nodes().size(), 2 * (80 + 80) - 1u);
  RandomStream random = make_random_stream(3u, 4u, 5u);
  for (int i = 0; i < 12; ++i) {
    const LitPoint point = random_point(random);
    expect_picks_by_probability(lights, point, no_pick_lobe());
    expect_picks_by_probability(lights, point,
                                lights.tree.bounded(point.position_ws, point.normal_ws,
                                                    shiny_lobe(point.normal_ws, random)));
  }
}

TEST(LightTree, PicksTogetherAreThoseByThemselves) {
  const Lights lights(many_lights(40));
  RandomStream random = make_random_stream(6u, 4u, 5u);
  for (int i = 0; i < 500; ++i) {
    const LitPoint point = random_point(random);
    const std::uint32_t count = 1 + static_cast<std::uint32_t>(i) % kMostPicks;
    LightPicks together;
    std::vector<float> u;
    for (std::uint32_t k = 0; k < count; ++k) u.push_back(next_uniform(random));
    std::sort(u.begin(), u.end());
    for (std::uint32_t k = 0; k < count; ++k) together.at[k].rest = u[k];
    const PickLobe lobe = i % 2 == 0 ? no_pick_lobe() : shiny_lobe(point.normal_ws, random);
    lights.tree.pick(point.position_ws, point.normal_ws, lobe, count, together);
    for (std::uint32_t k = 0; k < count; ++k) {
      const LightPick alone = lights.tree.pick(point.position_ws, point.normal_ws, lobe, u[k]);
      EXPECT_EQ(together.at[k].light, alone.light);
      EXPECT_EQ(together.at[k].probability, alone.probability);
      EXPECT_EQ(together.at[k].rest, alone.rest);
    }
  }
}

TEST(LightTree, PicksAsTheLoopOverSingleNodes) {
  const Lights lights(many_lights(40));
  RandomStream random = make_random_stream(7u, 4u, 5u);
  for (int i = 0; i < 500; ++i) {
    const LitPoint point = random_point(random);
    PickLobe lobe = i % 2 == 0 ? no_pick_lobe() : shiny_lobe(point.normal_ws, random);
    const PickLobe bounded = lights.tree.bounded(point.position_ws, point.normal_ws, lobe);
    lobe = bounded_lobe(lights.tree.groups(), point.position_ws, point.normal_ws, lobe);
    EXPECT_EQ(bounded.specular, lobe.specular);
    LightPicks picks, expected;
    for (std::uint32_t k = 0; k < kCandidates; ++k) {
      picks.at[k].rest = (static_cast<float>(k) + next_uniform(random)) / kCandidates;
      expected.at[k].rest = picks.at[k].rest;
    }
    lights.tree.pick(point.position_ws, point.normal_ws, lobe, kCandidates, picks);
    pick_lights(lights.tree.groups(), point.position_ws, point.normal_ws, lobe, kCandidates,
                expected);
    for (std::uint32_t k = 0; k < kCandidates; ++k) {
      EXPECT_EQ(picks.at[k].light, expected.at[k].light);
      EXPECT_EQ(picks.at[k].probability, expected.at[k].probability);
      EXPECT_EQ(picks.at[k].rest, expected.at[k].rest);
    }
  }
}

TEST(LightTree, LooksAtGroupsAsAtSingleNodes) {
  const Lights lights(many_lights(40));
  const LightGroups& groups = lights.tree.groups();
  RandomStream random = make_random_stream(8u, 4u, 5u);
  for (int i = 0; i < 300; ++i) {
    LitPoint point = random_point(random);
    if (i % 5 == 0) point.normal_ws = glm::vec3(0.0f);  // in the air
    const std::size_t group =
        static_cast<std::size_t>(i) % (groups.nodes().size() / kLightGroupSize);
    const PickLobe lobe =
        i % 2 == 0 || i % 5 == 0 ? no_pick_lobe() : shiny_lobe(point.normal_ws, random);
    float importances[kLightGroupSize];
    lambent::group_importances(groups.numbers(static_cast<std::uint32_t>(group)), point.position_ws,
                               point.normal_ws, lobe, importances);
    for (std::size_t k = 0; k < kLightGroupSize; ++k) {
      const LightTreeNode& node = groups.nodes()[group * kLightGroupSize + k];
      EXPECT_EQ(importances[k], light_importance(node, point.position_ws, point.normal_ws, lobe));
    }
  }
}

/// Relative variance of a pixel's light by one pick, where all lights of a row of lamps are seen in
/// a wet floor.
double variance_of_highlights(const LightTree& tree, std::size_t first_light, bool by_lobe) {
  const Reflectance floor{glm::vec3(0.05f), 0.06f, glm::vec3(0.04f), 1.0f, no_layers(), 1.0f};
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  const Frame frame = make_frame(up);
  double variance = 0.0;
  constexpr int kPoints = 40;
  for (int i = 0; i < kPoints; ++i) {
    const glm::vec3 position_ws(-2.0f + 0.1f * static_cast<float>(i), 0.0f, 8.0f);
    const glm::vec3 to_viewer_ws = glm::normalize(glm::vec3(0.0f, 1.7f, 18.0f) - position_ws);
    const glm::vec3 to_viewer = to_local(frame, to_viewer_ws);
    PickLobe lobe = no_pick_lobe();
    if (by_lobe) lobe = tree.bounded(position_ws, up, pick_lobe(floor, frame, to_viewer));
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < tree.lights().size(); ++k) {
      const PunctualSample sent = sample_punctual(tree.lights()[k], position_ws);
      const ReflectedPair pair =
          evaluate_reflectance(floor, to_viewer, to_local(frame, sent.to_light));
      const double light = luminance((pair.diffuse + pair.specular) * sent.irradiance);
      sum += light;
      squares +=
          light * light /
          tree.probability(static_cast<std::uint32_t>(first_light + k), position_ws, up, lobe);
    }
    variance += (squares / (sum * sum) - 1.0) / kPoints;
  }
  return variance;
}

TEST(LightTree, PicksWhatShinesInAWetFloor) {
  Scene scene;
  for (int i = 0; i < 40; ++i) {
    Light lamp;
    lamp.type = Light::Type::point;
    lamp.intensity = glm::vec3(100.0f);
    lamp.position_ws = {i % 2 == 0 ? -4.0f : 4.0f, 4.0f, -6.0f * static_cast<float>(i / 2)};
    scene.lights.push_back(lamp);
  }
  const Lights lights(scene);
  ASSERT_TRUE(lights.tree.asked().empty());
  const double evenly = variance_of_highlights(lights.tree, lights.emissive.size(), false);
  const double by_lobe = variance_of_highlights(lights.tree, lights.emissive.size(), true);
  std::printf("relative variance: %.2f evenly, %.2f by the lobe\n", evenly, by_lobe);
  EXPECT_LT(by_lobe, 0.1 * evenly);
}

/// Irradiance of a triangle or light at a point, if nothing is in the way.
float unoccluded(const Lights& lights, std::uint32_t light, const LitPoint& point) {
  LightCandidate candidate = no_candidate();
  if (light < lights.emissive.size()) {
    const EmitterRecord& e = lights.emissive.entries()[light];
    const TrianglePointSeen seen =
        draw_on_triangle(e.corner_ws - point.position_ws, e.edge1_ws, e.edge2_ws, {0.4f, 0.6f});
    if (seen.pdf <= 0.0f) return 0.0f;
    candidate = {seen.to_point, seen.distance, glm::vec3(1.0f / seen.pdf), 1};
  } else {
    const PunctualSample sample =
        sample_punctual(lights.tree.lights()[light - lights.emissive.size()], point.position_ws);
    candidate = {sample.to_light, sample.distance, sample.irradiance, 0};
  }
  return luminance(unoccluded_irradiance(point, seen_shape(point), candidate));
}

void expect_finds_all_that_shine(const Lights& lights, std::uint32_t seed) {
  std::vector<std::uint8_t> asked(lights.count(), 0);
  for (const std::uint32_t a : lights.tree.asked()) asked[lights.emissive.size() + a] = 1;
  RandomStream random = make_random_stream(seed, 4u, 5u);
  int shining = 0;
  for (int i = 0; i < 300; ++i) {
    const LitPoint point = random_point(random);
    for (std::uint32_t light = 0; light < lights.count(); ++light) {
      if (asked[light] != 0 || unoccluded(lights, light, point) <= 1e-6f) continue;
      ++shining;
      ASSERT_GT(lights.tree.probability(light, point.position_ws, point.normal_ws, no_pick_lobe()),
                0.0f)
          << "light " << light << ", point " << i;
    }
  }
  EXPECT_GT(shining, 5000);
}

TEST(LightTree, FindsEveryLightThatShinesOnAPoint) {
  expect_finds_all_that_shine(Lights(many_lights(40)), 1u);
}

TEST(LightTree, AsksAFewLightsAndDrawsFromMany) {
  Scene scene;
  scene.lights.push_back(test::sun(glm::vec3(1.0f), {0.0f, -1.0f, 0.0f}));
  for (std::size_t i = 0; i < kMaxLightsAsked; ++i) {
    scene.lights.push_back(test::point_light(glm::vec3(1.0f), glm::vec3(static_cast<float>(i))));
  }
  Lights lights(scene);
  EXPECT_EQ(lights.tree.asked().size(), kMaxLightsAsked + 1);
  EXPECT_TRUE(lights.tree.nodes().empty());
  EXPECT_EQ(lights.tree.pick(glm::vec3(0.0f), {0.0f, 1.0f, 0.0f}, no_pick_lobe(), 0.5f).probability,
            0.0f);
  scene.lights.push_back(test::point_light(glm::vec3(1.0f), glm::vec3(0.0f)));
  lights.update(scene);
  EXPECT_EQ(lights.tree.asked(), std::vector<std::uint32_t>{0});
  EXPECT_EQ(lights.tree.nodes().size(), 2 * (kMaxLightsAsked + 1) - 1);
}

TEST(LightTree, IsFittedToLightsThatMoveAndBuiltAgainOnceWornOut) {
  Scene scene = many_lights(40);
  Lights lights(scene);
  EXPECT_EQ(lights.tree.builds(), 1);
  // One lamp and one light go elsewhere
  scene.instances[10].world_from_object = glm::translate(glm::mat4(1.0f), glm::vec3(0.5f, 0.2f, 0));
  scene.lights[5].position_ws += glm::vec3(0.3f, -0.5f, 0.1f);
  lights.update(scene);
  EXPECT_EQ(lights.tree.builds(), 1);
  expect_finds_all_that_shine(lights, 2u);
  RandomStream random = make_random_stream(3u, 4u, 5u);
  for (int i = 0; i < 4; ++i) {
    expect_picks_by_probability(lights, random_point(random), no_pick_lobe());
  }
  // All are shuffled
  for (Light& light : scene.lights) light.position_ws = 30.0f * test::place_in_room(random);
  lights.update(scene);
  EXPECT_EQ(lights.tree.builds(), 2);
  expect_finds_all_that_shine(lights, 3u);
  // One is gone
  scene.lights.pop_back();
  lights.update(scene);
  EXPECT_EQ(lights.tree.builds(), 3);
}

/// Mean and variance of the luminance of samples of direct irradiance, over points of a room.
struct Estimate {
  double mean = 0.0, variance = 0.0;
};

TEST(LightTree, EstimatesTheSumOfAllLights) {
  // Where nothing casts shadows, the sum over the lights is the truth
  Scene scene;
  RandomStream random = make_random_stream(11u, 0u, 0u);
  for (int i = 0; i < 200; ++i) {
    scene.lights.push_back(test::point_light(glm::vec3(1.0f), test::place_in_room(random)));
  }
  const World world(scene);
  const Lights lights(scene);
  constexpr int kPoints = 10, kSamples = 4000;
  double ratios = 0.0;  // of variances, over drawing by power
  for (int p = 0; p < kPoints; ++p) {
    const LitPoint point = random_point(random);
    double expected = 0.0;
    for (std::uint32_t i = 0; i < lights.count(); ++i) expected += unoccluded(lights, i, point);
    std::vector<DirectLightQuery> queries;
    for (std::size_t i = 0; i < kSamples; ++i) queries.push_back({point, i});
    std::vector<glm::vec3> found(kSamples);
    ShadeHitsScratch scratch;
    EXPECT_LE(direct_irradiance(world, queries, {}, scratch, found), std::size_t{kSamples});
    Estimate estimate;
    for (const glm::vec3& e : found) estimate.mean += e.x / kSamples;
    for (const glm::vec3& e : found) {
      estimate.variance += (e.x - estimate.mean) * (e.x - estimate.mean) / kSamples;
    }
    EXPECT_NEAR(estimate.mean, expected, 4.0 * std::sqrt(estimate.variance / kSamples) + 1e-4);
    // Drawn by power, each of 200 equal lights is worth 200 times its light
    double squares = 0.0;
    for (std::uint32_t i = 0; i < lights.count(); ++i) {
      squares += 200.0 * std::pow(unoccluded(lights, i, point), 2.0);
    }
    ratios += estimate.variance / (squares - expected * expected);
  }
  EXPECT_LT(ratios / kPoints, 0.07);
}

// What coats and samples of emitters share lamps by.
TEST(LightTree, BoundsTheFluence) {
  Scene scene;
  EXPECT_EQ(Lights(scene).tree.fluence(vec3(0.0f)), 0.0f);
  // More than are asked one by one, all at a distance of 2 m
  constexpr int kLights = 20;
  for (int i = 0; i < kLights; ++i) {
    const float angle = static_cast<float>(i);
    scene.lights.push_back(
        test::point_light(glm::vec3(3.0f), 2.0f * vec3(std::cos(angle), std::sin(angle), 0.0f)));
  }
  const float sum = kLights * 3.0f / 4.0f;
  const Lights lights(scene);
  EXPECT_GT(lights.tree.fluence(vec3(0.0f)), sum);
  EXPECT_LT(lights.tree.fluence(vec3(0.0f)), 4.0f * sum);  // clusters count by near ends
  // From far away
  EXPECT_NEAR(lights.tree.fluence(vec3(0.0f, 0.0f, 200.0f)), sum * 1e-4f, 1e-3f * sum * 1e-4f);
}

}  // namespace
}  // namespace lambent::light_tree_test
