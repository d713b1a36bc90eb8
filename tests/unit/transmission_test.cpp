// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "raytracing/transmission_math.h"
#include "raytracing/world_access.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "shared/random.h"

namespace lambent::transmission_test {
namespace {

const vec3 kUp(0.0f, 0.0f, 1.0f);

vec3 towards(float angle) {
  return {std::sin(angle), 0.0f, std::cos(angle)};
}

Reflectance dielectric(float ior) {
  return coated_reflectance(vec3(1.0f), 0.0f, 0.0f, 1.0f, vec3(1.0f), ior);
}

Transmission volume(uint kind, float eta) {
  return {vec3(1.0f), kind, vec3(0.0f), eta, kMinGgxAlpha};
}

TEST(DrawThrough, RefractsAsSnellSays) {
  constexpr float kIor = 1.5f;
  for (const float angle : {0.0f, 0.3f, 0.8f, 1.4f}) {
    const ThroughDraw drawn = draw_through(volume(kEntersVolume, 1.0f / kIor), dielectric(kIor),
                                           kUp, towards(angle), vec3(0.5f));
    EXPECT_EQ(drawn.crosses, 1u);
    EXPECT_LT(drawn.direction_ws.z, 0.0f);
    EXPECT_NEAR(kIor * -drawn.direction_ws.x, std::sin(angle), 1e-5f) << angle;
  }
}

TEST(DrawThrough, LeavesAVolumeWithTheShareThatEnters) {
  constexpr float kIor = 1.5f;
  for (const float outside : {0.1f, 0.6f, 1.2f}) {
    const float inside = std::asin(std::sin(outside) / kIor);
    const vec3 entering = vec3(1.0f) - fresnel(dielectric(kIor), std::cos(outside));
    EXPECT_NEAR(1.0f - inner_reflection(std::cos(inside), kIor), entering.x, 1e-5f) << outside;
  }
}

TEST(DrawThrough, ReflectsEverythingBeyondTheCriticalAngle) {
  constexpr float kIor = 1.5f;
  const float critical = std::asin(1.0f / kIor);
  for (uint i = 0; i < 64; ++i) {
    RandomStream random = make_random_stream(i, 0u, 1u);
    const vec2 u = next_uniform2(random);
    const ThroughDraw drawn =
        draw_through(volume(kLeavesVolume, kIor), dielectric(kIor), kUp, towards(critical + 0.05f),
                     vec3(u, next_uniform(random)));
    EXPECT_EQ(drawn.crosses, 0u);
    EXPECT_EQ(drawn.weight, vec3(1.0f));
    EXPECT_NEAR(drawn.direction_ws.x, -towards(critical + 0.05f).x, 1e-5f);
  }
}

TEST(DrawThrough, OfRoughGlassKeepsToItsSideAndItsEnergy) {
  for (const uint kind : {kCrossesPane, kEntersVolume}) {
    Transmission through = volume(kind, kind == kCrossesPane ? 1.0f : 1.0f / 1.5f);
    through.alpha = 0.2f;
    const Reflectance reflectance = dielectric(1.5f);
    vec3 mean(0.0f);
    constexpr uint kDraws = 4096;
    for (uint i = 0; i < kDraws; ++i) {
      RandomStream random = make_random_stream(i, 0u, 1u);
      const vec2 u = next_uniform2(random);
      const ThroughDraw drawn =
          draw_through(through, reflectance, kUp, towards(0.4f), vec3(u, next_uniform(random)));
      if (drawn.weight == vec3(0.0f)) continue;
      EXPECT_LT(drawn.direction_ws.z, 0.0f);
      mean += drawn.weight / static_cast<float>(kDraws);
    }
    // What the boundary does not reflect, less what microfacets shadow: of a pane as much as of its
    // reflection
    const float shadowed = kind == kCrossesPane ? ggx_albedo(std::cos(0.4f), through.alpha) : 1.0f;
    EXPECT_NEAR(mean.x, 0.96f * shadowed, 0.015f) << kind;
  }
}

// Weights of multiple importance sampling need the density that rays are drawn with, and samples of
// lights the lobe: their ratio is the weight of a ray. Both are integrated over the sphere, and
// over a quarter of it, to which rough panes and boundaries send different shares.
TEST(EvaluateThrough, IsTheLobeAndTheDensityThatRaysAreDrawnWith) {
  for (const uint kind : {kCrossesPane, kLeavesVolume}) {
    Transmission through = volume(kind, kind == kCrossesPane ? 1.0f : 1.5f);
    through.alpha = 0.3f;
    through.tint = {0.9f, 0.5f, 0.7f};
    const Reflectance reflectance = dielectric(1.5f);
    const Frame frame = make_frame(kUp);
    const vec3 to_viewer_ws = towards(0.5f), to_viewer = to_local(frame, to_viewer_ws);
    const vec3 side = to_local(frame, vec3(1.0f, 0.0f, 0.0f));
    constexpr uint kDraws = 1 << 16;
    double drawn_share = 0.0, drawn_beside = 0.0;
    for (uint i = 0; i < kDraws; ++i) {
      RandomStream random = make_random_stream(i, 0u, 1u);
      const vec2 u = next_uniform2(random);
      const ThroughDraw drawn =
          draw_through(through, reflectance, kUp, to_viewer_ws, vec3(u, next_uniform(random)));
      if (drawn.crosses == 0u || drawn.weight == vec3(0.0f)) {
        EXPECT_EQ(drawn.pdf, 0.0f);
        continue;
      }
      const vec3 to_light = to_local(frame, drawn.direction_ws);
      const ThroughLobe lobe = evaluate_through(through, reflectance, to_viewer, to_light);
      ASSERT_NEAR(lobe.pdf, drawn.pdf, 0.01f * drawn.pdf) << kind;
      const vec3 weight = lobe.value / lobe.pdf;
      ASSERT_NEAR(weight.y, drawn.weight.y, 0.002f) << kind;
      drawn_share += 1.0 / kDraws;
      if (dot(to_light, side) < -0.5f) drawn_beside += 1.0 / kDraws;
    }
    constexpr int kRings = 400, kSectors = 400;
    double share = 0.0, beside = 0.0;
    for (int r = 0; r < kRings; ++r) {
      for (int s = 0; s < kSectors; ++s) {
        const float z = -(static_cast<float>(r) + 0.5f) / kRings;
        const float angle = kTwoPi * (static_cast<float>(s) + 0.5f) / kSectors;
        const float radius = std::sqrt(1.0f - z * z);
        const vec3 to_light(radius * std::cos(angle), radius * std::sin(angle), z);
        const double part = evaluate_through(through, reflectance, to_viewer, to_light).pdf *
                            static_cast<double>(kTwoPi) / (kRings * kSectors);
        share += part;
        if (dot(to_light, side) < -0.5f) beside += part;
      }
    }
    EXPECT_NEAR(share, drawn_share, 0.005) << kind;
    EXPECT_NEAR(beside, drawn_beside, 0.005) << kind;
    EXPECT_GT(beside, 0.1) << kind;
  }
}

TEST(EvaluateThrough, LeavesToRaysWhatSamplesCannotReach) {
  Transmission through = volume(kCrossesPane, 1.0f);
  EXPECT_FALSE(samples_lights_behind(through));  // smooth
  through.alpha = 0.1f;
  EXPECT_TRUE(samples_lights_behind(through));
  through.kind = kEntersVolume;  // light is bent again where it leaves
  EXPECT_FALSE(samples_lights_behind(through));
  through.kind = kLeavesVolume;  // an index of 1 does not spread light
  EXPECT_FALSE(samples_lights_behind(through));
  through.eta = 1.5f;
  EXPECT_TRUE(samples_lights_behind(through));
  through.tint = vec3(0.0f);
  EXPECT_FALSE(samples_lights_behind(through));
}

/// A pane across z = 0 and a ball of radius 1 around (0, 0, 3).
Scene pane_and_ball(bool mirrored) {
  Scene scene;
  Material glass;
  glass.metallic = 0.0f;
  glass.roughness = 0.0f;
  glass.transmission = 1.0f;
  glass.base_color = {0.5f, 0.8f, 1.0f, 1.0f};
  scene.materials.push_back(glass);
  glass.base_color = glm::vec4(1.0f);
  glass.bounds_volume = true;
  glass.absorption = {0.25f, 0.5f, 1.0f};
  scene.materials.push_back(glass);
  scenes::MeshBuilder builder;
  builder.quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
  scenes::add_object(scene, builder.take("pane", 0));
  constexpr int kSteps = 64;
  std::vector<vec2> profile;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = kPi * static_cast<float>(i) / kSteps;
    const bool pole = i == 0 || i == kSteps;
    profile.emplace_back(pole ? 0.0f : std::sin(angle), -std::cos(angle));
  }
  builder.lathe(vec3(0.0f), profile, 2 * kSteps);
  mat4 place(1.0f);
  place[3] = vec4(0.0f, 0.0f, 3.0f, 1.0f);
  if (mirrored) place[0][0] = -1.0f;
  scenes::add_object(scene, builder.take("ball", 1), place);
  return scene;
}

vec3 share_along(const World& world, const Ray& ray) {
  vec3 share(-1.0f);
  tracer_of(world).transmittances({&ray, 1}, {&share, 1});
  return share;
}

TEST(Transmittance, OfAPaneIsItsTintLessWhatItReflects) {
  const Scene scene = pane_and_ball(false);
  const World world(scene);
  ASSERT_TRUE(tracer_of(world).has_glass());
  Ray ray{{1.5f, 0.0f, -1.0f}, 0.0f, kUp, 2.0f};
  const vec3 share = share_along(world, ray);
  EXPECT_NEAR(share.x, 0.5f * 0.96f, 1e-5f);
  EXPECT_NEAR(share.y, 0.8f * 0.96f, 1e-5f);
  EXPECT_NEAR(share.z, 1.0f * 0.96f, 1e-5f);
  EXPECT_FALSE(tracer_of(world).occluded(ray));
  // A camera sees the pane
  EXPECT_FALSE(tracer_of(world).closest_hit(ray).missed());
}

TEST(Transmittance, OfAVolumeFallsWithTheWayThroughIt) {
  for (const bool mirrored : {false, true}) {
    const Scene scene = pane_and_ball(mirrored);
    const World world(scene);
    for (const float aside : {0.0f, 0.5f}) {
      const float way = 2.0f * std::sqrt(1.0f - aside * aside);
      const float cosine = std::sqrt(1.0f - aside * aside);
      const vec3 passes = vec3(1.0f) - fresnel(dielectric(1.5f), cosine);
      const Ray ray{{aside, 0.01f, 1.0f}, 0.0f, kUp, 5.0f};
      const vec3 share = share_along(world, ray);
      for (int c = 0; c < 3; ++c) {
        const float left = std::exp(-scene.materials[1].absorption[c] * way);
        EXPECT_NEAR(share[c] / (passes[c] * left), 1.0f, 0.005f) << mirrored << ' ' << aside;
      }
    }
  }
}

TEST(Transmittance, OfProbeRaysIsRightOnAverage) {
  const Scene scene = pane_and_ball(false);
  const World world(scene);
  constexpr uint kRays = 4096;
  vec3 mean(0.0f);
  for (uint i = 0; i < kRays; ++i) {
    RandomStream random = make_random_stream(i, 0u, 1u);
    const vec2 u = next_uniform2(random);
    Ray ray{{-1.9f + 0.5f * u.x, 3.0f * u.y - 1.5f, -1.0f}, 0.0f, kUp, 2.0f, kRayOfProbe};
    const Hit hit = tracer_of(world).closest_hit(ray);
    if (!hit.missed()) continue;
    mean += share_along(world, ray) / static_cast<float>(kRays);
  }
  EXPECT_NEAR(mean.x, 0.5f * 0.96f, 0.01f);
  EXPECT_NEAR(mean.z, 1.0f * 0.96f, 0.01f);
}

}  // namespace
}  // namespace lambent::transmission_test
