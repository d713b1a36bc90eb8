// SPDX-License-Identifier: Apache-2.0
// The interleaved gather against the exhaustive one over all texels of its maps, and that against
// one bounce of light without visibility, found by rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/parallel.h"
#include "golden/truth.h"
#include "lambent/rsm.h"
#include "raytracing/camera_rays.h"
#include "raytracing/direct_light.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "shared/color.h"
#include "support/field_scenes.h"

namespace lambent::rsm_reference_test {
namespace {

using test::Stage;

// Errors are measured at every so manyth pixel, of both axes, of the whole picture: the exhaustive
// gather is too slow for all.
constexpr int kWidth = 1920, kHeight = 1080, kStep = 11;

/// A scene, its picture and what the exhaustive gather finds at some of its pixels.
struct RsmStage {
  RsmStage(Scene scene, const Camera& from)
      : stage(std::move(scene)),
        camera(from),
        maps(render_rsms(stage.world, camera, aspect(), {}).value()) {
    constexpr std::size_t kPixels = static_cast<std::size_t>(kWidth) * kHeight;
    positions.resize(kPixels);
    normals.assign(kPixels, vec3(0.0f));
    depths.assign(kPixels, 0.0f);
    parallel_chunks(kHeight, 1, [&](std::size_t y, std::size_t) {
      for (int x = 0; x < kWidth; ++x) {
        const Ray ray = camera_ray(camera, kWidth, kHeight, static_cast<float>(x) + 0.5f,
                                   static_cast<float>(y) + 0.5f);
        const Hit hit = tracer_of(stage.world).closest_hit(ray);
        if (hit.missed()) continue;
        const Surface surface = surface_at(stage.scene, ray, hit);
        const std::size_t i = y * kWidth + x;
        positions[i] = surface.position_ws;
        normals[i] = surface.normal_ws;
        depths[i] = view_depth(camera, surface.position_ws);
      }
    });
    for (int y = kStep / 2; y < kHeight; y += kStep) {
      for (int x = kStep / 2; x < kWidth; x += kStep) {
        const std::size_t i = static_cast<std::size_t>(y) * kWidth + x;
        if (normals[i] == vec3(0.0f)) continue;
        chosen.push_back(i);
        few_positions.push_back(positions[i]);
        few_normals.push_back(normals[i]);
        few_depths.push_back(depths[i]);
      }
    }
    RsmSettings all;
    all.texels = 0;
    all.sub_maps = all.sub_images = 1;
    all.sub_blur_radius = 0;
    all.final_blur = false;
    const RsmView few{static_cast<int>(chosen.size()), 1, few_positions, few_normals, few_depths};
    RsmIrradiance light;
    EXPECT_TRUE(RsmGatherer().gather(stage.world, maps, few, all, light));
    exhaustive = light.irradiance;
  }
  static float aspect() { return static_cast<float>(kWidth) / kHeight; }

  /// Whether a depth edge is within two pixels on either side.
  bool near_edge(std::size_t pixel) const {
    const int x = static_cast<int>(pixel % kWidth), y = static_cast<int>(pixel / kWidth);
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= kWidth || y + dy >= kHeight) continue;
        const std::size_t other = static_cast<std::size_t>(y + dy) * kWidth + x + dx;
        const float off = std::abs(dot(positions[other] - positions[pixel], normals[pixel]));
        if (depths[other] == 0.0f || off > 0.02f * depths[pixel]) return true;
      }
    }
    return false;
  }

  const Stage stage;
  const Camera camera;
  std::vector<ReflectiveShadowMap> maps;
  std::vector<vec3> positions, normals, few_positions, few_normals;
  std::vector<float> depths, few_depths;
  std::vector<std::size_t> chosen;
  std::vector<vec3> exhaustive;
};

struct Errors {
  double relative_rmse = 0.0, at_edges = 0.0, mean_ratio = 0.0;
};

Errors errors_of(const RsmStage& work, const char* name) {
  RsmIrradiance light;
  EXPECT_TRUE(RsmGatherer().gather(work.stage.world, work.maps,
                                   {kWidth, kHeight, work.positions, work.normals, work.depths}, {},
                                   light));
  double square[2] = {}, truth[2] = {}, count[2] = {}, mean = 0.0;
  for (std::size_t k = 0; k < work.chosen.size(); ++k) {
    const int edge = work.near_edge(work.chosen[k]) ? 1 : 0;
    for (int c = 0; c < 3; ++c) {
      const double ours = light.irradiance[work.chosen[k]][c], exact = work.exhaustive[k][c];
      square[edge] += (ours - exact) * (ours - exact);
      truth[edge] += exact;
      mean += ours;
      count[edge] += 1.0;
    }
  }
  const double all = count[0] + count[1], sum = truth[0] + truth[1];
  Errors errors;
  errors.relative_rmse = std::sqrt((square[0] + square[1]) / all) / (sum / all);
  if (count[1] > 0.0) errors.at_edges = std::sqrt(square[1] / count[1]) / (sum / all);
  errors.mean_ratio = mean / sum;
  std::printf("rsm %s: relative RMSE %.4f, within 2 pixels of depth edges %.4f, mean ratio %.4f\n",
              name, errors.relative_rmse, errors.at_edges, errors.mean_ratio);
  return errors;
}

/// One bounce of the scene's lights at a point as if nothing stood between it and what reflects:
/// rays of the cosine hemisphere that go through everything.
vec3 unoccluded_bounce(const Stage& stage, const vec3& position, const vec3& normal, int rays) {
  const Frame frame = make_frame(normal);
  vec3 sum(0.0f);
  for (int i = 0; i < rays; ++i) {
    const vec2 u = fract(plastic_sequence(static_cast<uint>(i)) + vec2(0.5f));
    Ray ray{offset_ray_origin(position, normal), 0.0f,
            to_world(frame, sample_cosine_hemisphere(u))};
    for (Hit hit = tracer_of(stage.world).closest_hit(ray); !hit.missed();
         hit = tracer_of(stage.world).closest_hit(ray)) {
      const Surface s = surface_at(stage.scene, ray, hit);
      RandomStream random = make_random_stream(0, 0, 0);
      for_each_light({stage.world, 1}, {{s.position_ws, s.normal_ws, s.geometric_normal_ws}},
                     random, [&](const LightCandidate& light) {
                       const float cosine = dot(s.normal_ws, light.to_light);
                       if (cosine <= 0.0f || dot(s.geometric_normal_ws, light.to_light) <= 0.0f) {
                         return;
                       }
                       if (tracer_of(stage.world)
                               .occluded(shadow_ray(s.position_ws, s.geometric_normal_ws, light))) {
                         return;
                       }
                       sum += effective_albedo(s.reflectance, cosine) *
                              light.perpendicular_irradiance * cosine;
                     });
      ray.t_min = hit.distance * 1.0001f + 1e-4f;
    }
  }
  return sum / static_cast<float>(rays);
}

/// Mean of the exhaustive gather over that of one bounce without visibility by rays, of which few
/// at each point suffice for the mean; at every `step`-th of the chosen pixels.
double over_unoccluded_bounce(const RsmStage& work, std::size_t step, const char* name) {
  constexpr int kRays = 64;
  const std::size_t count = work.chosen.size() / step;
  std::vector<vec3> bounce(count);
  parallel_chunks(count, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      bounce[i] = unoccluded_bounce(work.stage, work.few_positions[i * step],
                                    work.few_normals[i * step], kRays);
    }
  });
  double ours = 0.0, truth = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    ours += luminance(work.exhaustive[i * step]);
    truth += luminance(bounce[i]);
  }
  std::printf("rsm %s: exhaustive mean over one bounce without visibility %.4f\n", name,
              ours / truth);
  return ours / truth;
}

TEST(RsmAgainstExhaustive, IsWithinFivePercentOnCornell) {
  const Scene scene = scenes::make("cornell-spot").value();
  const RsmStage work(scene, scene.cameras[0]);
  const Errors errors = errors_of(work, "cornell-spot");
  // Bars of this and the next test: 5 % and 8 % of error, 2 % of energy
  EXPECT_LT(errors.relative_rmse, 0.05);
  EXPECT_NEAR(errors.mean_ratio, 1.0, 0.02);
  const double over_bounce = over_unoccluded_bounce(work, 1, "cornell-spot");
  EXPECT_NEAR(errors.mean_ratio * over_bounce, 1.0, 0.02);
}

TEST(RsmAgainstExhaustive, IsWithinEightPercentOnSponza) {
  const std::filesystem::path path = test::shared_dir() / "scenes" / "Sponza/Sponza.gltf";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  Scene scene = load_scene(path.string()).value();
  Light sun;
  sun.type = Light::Type::directional;
  sun.intensity = {20.0f, 18.0f, 15.0f};
  sun.direction_ws = normalize(vec3(-0.62f, -0.8f, 0.10f));
  scene.lights.push_back(sun);
  const RsmStage work(std::move(scene),
                      look_at({-10.2f, 1.7f, 4.0f}, {-9.0f, 1.4f, -3.0f}, 70.0f * kPi / 180.0f));
  const Errors errors = errors_of(work, "Sponza");
  EXPECT_LT(errors.relative_rmse, 0.08);
  EXPECT_NEAR(errors.mean_ratio, 1.0, 0.02);
  // Rays through all of Sponza are many: few points
  constexpr std::size_t kPointStep = 4;
  const double over_bounce = over_unoccluded_bounce(work, kPointStep, "Sponza");
  EXPECT_NEAR(errors.mean_ratio * over_bounce, 1.0, 0.02);
}

}  // namespace
}  // namespace lambent::rsm_reference_test
