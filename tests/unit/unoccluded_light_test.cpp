// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree/unoccluded_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/light_tree/unoccluded_math.h"
#include "shared/color.h"
#include "shared/sampling.h"
#include "support/many_lights.h"

namespace lambent::unoccluded_light_test {
namespace {

/// The share of cosine-distributed directions that meet a triangle.
double counted_form_factor(vec3 a, vec3 b, vec3 c, vec3 normal, RandomStream& random) {
  constexpr int kSide = 300;
  const Frame frame = make_frame(normal);
  const float volume = dot(a, cross(b, c));
  int met = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const vec2 jitter = next_uniform2(random);
    const vec2 u((static_cast<float>(i % kSide) + jitter.x) / kSide,
                 (static_cast<float>(i / kSide) + jitter.y) / kSide);
    const vec3 d = to_world(frame, sample_cosine_hemisphere(u));
    const float x = dot(d, cross(a, b)), y = dot(d, cross(b, c)), z = dot(d, cross(c, a));
    if (x * volume > 0.0f && y * volume > 0.0f && z * volume > 0.0f) ++met;
  }
  return static_cast<double>(met) / (kSide * kSide);
}

vec3 random_vector(RandomStream& random) {
  return 2.0f * next_uniform(random) * sample_uniform_sphere(next_uniform2(random));
}

TEST(UnoccludedLight, FormFactorsOfTrianglesAreThoseThatRaysCount) {
  RandomStream random = make_random_stream(1, 2, 3);
  int cut = 0;
  for (int i = 0; i < 60; ++i) {
    const vec3 a = random_vector(random), b = random_vector(random), c = random_vector(random);
    const vec3 normal = sample_uniform_sphere(next_uniform2(random));
    const int above = (dot(a, normal) > 0.0f ? 1 : 0) + (dot(b, normal) > 0.0f ? 1 : 0) +
                      (dot(c, normal) > 0.0f ? 1 : 0);
    cut += above == 1 || above == 2 ? 1 : 0;
    const double counted = counted_form_factor(a, b, c, normal, random);
    EXPECT_NEAR(triangle_form_factor(a, b - a, c - a, normal), counted, 2e-3) << i;
    EXPECT_NEAR(triangle_form_factor(b, c - b, a - b, normal), counted, 2e-3) << i;
  }
  EXPECT_GT(cut, 20);
}

struct Lit {
  explicit Lit(const Scene& scene) : emissive(scene), tree(scene, emissive) {}
  float at(const vec3& position, const vec3& normal) const {
    return luminance(unoccluded_light(tree, emissive, position, normal));
  }
  /// The same of each of the tree's lights by itself.
  float of_each(const vec3& position, const vec3& normal) const {
    float sum = 0.0f;
    const float share_of_power = emissive.total_power() / kTwoPi;
    for (const EmitterRecord& e : emissive.entries()) {
      sum += e.probability * share_of_power / e.area *
             triangle_form_factor(e.corner_ws - position, e.edge1_ws, e.edge2_ws, normal);
    }
    for (std::size_t i = 0; i < tree.lights().size(); ++i) {
      const bool asked = std::count(tree.asked().begin(), tree.asked().end(), i) > 0;
      if (asked) continue;
      const PunctualSample s = sample_punctual(tree.lights()[i], position);
      sum += kInvPi * luminance(s.irradiance) * std::max(dot(s.to_light, normal), 0.0f);
    }
    return sum;
  }
  EmissiveTriangles emissive;
  LightTree tree;
};

/// Root mean square of how far the light is off that of all lights one by one, over its mean.
double error_of(const Scene& scene) {
  const Lit lit(scene);
  RandomStream random = make_random_stream(4, 5, 6);
  double squares = 0.0, sum = 0.0;
  constexpr int kPoints = 300;
  for (int i = 0; i < kPoints; ++i) {
    const vec3 place = test::place_in_room(random);
    const vec3 normal = sample_uniform_sphere(next_uniform2(random));
    const double light = lit.at(place, normal), all = lit.of_each(place, normal);
    EXPECT_GE(light, 0.0);
    squares += (light - all) * (light - all);
    sum += all;
  }
  return std::sqrt(squares / kPoints) / (sum / kPoints);
}

TEST(UnoccludedLight, IsCloseToTheSumOfAllLights) {
  Scene scene = test::many_lights(100);
  // Clusters say little of narrow cones that point any way
  EXPECT_LT(error_of(scene), 0.25);
  std::erase_if(scene.lights, [](const Light& light) { return light.type == Light::Type::spot; });
  // Pictures need a level that is smooth, not one that is exact
  EXPECT_LT(error_of(scene), 0.19);
  scene.lights.clear();
  EXPECT_LT(error_of(scene), 0.15);
}

TEST(UnoccludedLight, OfFewLightsNearbyIsExact) {
  Scene scene;
  scene.materials = {test::lambert(vec3(0.0f), vec3(2.0f))};
  test::add(scene, test::quad(vec3(-0.5f, -0.5f, 0.2f), vec3(1.0f, 0.0f, 0.0f),
                              vec3(0.0f, 1.0f, 0.0f), 0));
  const Lit lit(scene);
  // A square seen from below its middle; the height is 0.4 times its half edge
  const float side = 0.4f, edge = std::atan(1.0f / std::sqrt(1.0f + side * side));
  const float corner = 1.0f / std::sqrt(1.0f + side * side) * edge;
  EXPECT_NEAR(lit.at(vec3(0.0f), vec3(0.0f, 0.0f, 1.0f)), 2.0f * 4.0f * corner * kInvPi, 1e-3f);
  EXPECT_EQ(lit.at(vec3(0.0f), vec3(0.0f, 0.0f, -1.0f)), 0.0f);
}

TEST(UnoccludedLight, HasNoStepsFromPlaceToPlace) {
  const Lit lit(test::many_lights(100));
  RandomStream random = make_random_stream(7, 8, 9);
  constexpr float kStep = 1e-5f;  // [m]
  for (int line = 0; line < 20; ++line) {
    const vec3 normal = sample_uniform_sphere(next_uniform2(random));
    const vec3 from = test::place_in_room(random), to = test::place_in_room(random);
    for (int i = 0; i < 400; ++i) {
      const vec3 here = mix(from, to, static_cast<float>(i) / 400.0f);
      const vec3 there = here + kStep * normalize(to - from);
      const float a = lit.at(here, normal), b = lit.at(there, normal);
      EXPECT_NEAR(a, b, 2e-3f * (a + b) + 1e-6f) << line << " " << i;
    }
  }
}

}  // namespace
}  // namespace lambent::unoccluded_light_test
