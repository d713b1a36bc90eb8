// SPDX-License-Identifier: Apache-2.0
// Emissive triangles whose edges are so short that squares of their products are less than any
// float.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "raytracing/shade_hits.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"
#include "scene/light_tree/light_tree.h"
#include "shared/random.h"
#include "support/panels.h"

namespace lambent::tiny_lights_test {
namespace {

constexpr float kEmission = 2.0f;  // [W/(m^2 sr)]
// Edges of lamps [m]: of scenes modelled in micrometres, and down to where products of the edges of
// pieces have squares of 1e-66.
constexpr float kSides[] = {1e-6f, 1e-9f, 1e-12f, 1e-15f};
constexpr int kSamples = 20000;
constexpr double kNoise = 0.03;
constexpr float kRounding = 1e-4f;

/// A square lamp about the origin, that faces upwards, under a clearcoat. With a texture it shines
/// in pieces.
Scene lamp(float side, bool textured) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f), glm::vec3(kEmission))};
  scene.materials[0].lambert = false;
  scene.materials[0].clearcoat = 1.0f;
  if (textured) {
    scene.textures = {test::panel_texture(128)};
    scene.materials[0].emission_texture.texture = 0;
  }
  Mesh mesh = test::quad({-0.5f, 0.0f, -0.5f}, {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, 0);
  for (glm::vec3& position : mesh.positions) position *= side;
  test::add(scene, std::move(mesh));
  return scene;
}

/// Irradiance at a point so many sides above a lamp of this side [W/m^2], by lights picked of its
/// tree.
double irradiance_above(const EmissiveTriangles& lights, const LightTree& tree, float height) {
  const glm::vec3 position_ws(0.0f, height, 0.0f), normal_ws(0.0f, -1.0f, 0.0f);
  RandomStream random = make_random_stream(7u, 0u, 0u);
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const LightPick pick = tree.pick(position_ws, normal_ws, no_pick_lobe(), next_uniform(random));
    const glm::vec2 u = next_uniform2(random);
    if (!(pick.probability > 0.0f)) continue;
    const EmitterRecord& emitter = lights.entries()[pick.light];
    const TrianglePointSeen seen =
        draw_on_triangle(emitter.corner_ws - position_ws, emitter.edge1_ws, emitter.edge2_ws, u);
    if (!(seen.pdf > 0.0f)) continue;
    const glm::vec3 sent = lights.radiance(emitter, seen.barycentrics, seen.to_point);
    sum += sent.x * glm::dot(seen.to_point, normal_ws) / (seen.pdf * pick.probability * kSamples);
  }
  return sum;
}

class TinyLights : public testing::TestWithParam<float> {};

TEST_P(TinyLights, AreAsBrightAsLargeOnes) {
  const float side = GetParam();
  for (const bool textured : {false, true}) {
    SCOPED_TRACE(textured);
    const Scene small_scene = lamp(side, textured), large_scene = lamp(1.0f, textured);
    const EmissiveTriangles lights(small_scene), large(large_scene);
    ASSERT_EQ(lights.size(), large.size());
    ASSERT_GT(lights.size(), textured ? 100u : 1u);
    const float area = side * side;
    EXPECT_NEAR(lights.total_power() / area / large.total_power(), 1.0f, kRounding);
    for (std::size_t e = 0; e < lights.size(); ++e) {
      const EmitterRecord& emitter = lights.entries()[e];
      ASSERT_NEAR(emitter.probability / large.entries()[e].probability, 1.0f, kRounding);
      ASSERT_NEAR(emitter.area / area / large.entries()[e].area, 1.0f, kRounding);
    }
    RandomStream random = make_random_stream(5u, 0u, 0u);
    for (int i = 0; i < 1000; ++i) {
      const glm::vec3 u(next_uniform(random), next_uniform2(random));
      const EmissiveSample drawn = lights.sample(u), expected = large.sample(u);
      ASSERT_NEAR(drawn.pdf_area * area / expected.pdf_area, 1.0f, kRounding);
      ASSERT_NEAR(glm::length(drawn.normal_ws), 1.0f, kRounding);
    }

    const LightTree tree(small_scene, lights), large_tree(large_scene, large);
    for (const LightTreeNode& node : tree.nodes()) {
      ASSERT_NEAR(glm::length(node.axis_ws), 1.0f, kRounding);
      ASSERT_GT(node.cos_spread, 0.99f);
      ASSERT_GT(node.intensity, 0.0f);
    }
    EXPECT_NEAR(
        irradiance_above(lights, tree, 0.7f * side) / irradiance_above(large, large_tree, 0.7f),
        1.0, kNoise);
    // From far away, as the large one from 1 km
    EXPECT_NEAR(irradiance_above(lights, tree, 1000.0f * side) /
                    irradiance_above(large, large_tree, 1000.0f),
                1.0, kNoise);
  }
}

INSTANTIATE_TEST_SUITE_P(Sides, TinyLights, testing::ValuesIn(kSides));

TEST(TinyLightsInAScene, LightWhatIsFarAway) {
  for (const float side : kSides) {
    const Scene scene = lamp(side, false);
    const World world(scene);
    const LitPoint point{{0.0f, 1.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, {0.0f, -1.0f, 0.0f}};
    std::vector<DirectLightQuery> queries;
    for (std::size_t i = 0; i < 100; ++i) queries.push_back({point, i});
    std::vector<glm::vec3> found(queries.size());
    ShadeHitsScratch scratch;
    direct_irradiance(world, queries, {}, scratch, found);
    double mean = 0.0;
    for (const glm::vec3& irradiance : found) {
      mean += irradiance.x / static_cast<double>(found.size());
    }
    const double passes_clearcoat = 0.96;
    EXPECT_NEAR(mean / (static_cast<double>(side) * side * kEmission * passes_clearcoat), 1.0,
                kNoise)
        << side;
  }
}

}  // namespace
}  // namespace lambent::tiny_lights_test
