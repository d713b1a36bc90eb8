// SPDX-License-Identifier: Apache-2.0
// Measures direct light of the scene `lamps`, at the points that its camera sees: the cost as the
// numbers of lights and emissive triangles grow, and the noise compared to drawing lights by power.
//
// usage: lambent_lights [REPETITIONS]    of each measurement (9); the median counts
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <vector>

#include "bench/lights/by_power.h"
#include "bench/median.h"
#include "bench/stage.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "scenes/builtin.h"
#include "shared/color.h"

namespace lambent::bench {
namespace {

constexpr int kWidth = 160, kHeight = 90;
// Rounds from which the variance of a point is estimated.
constexpr int kRounds = 64;

/// Target of the camera [m].
constexpr glm::vec3 kMiddle(0.0f, 5.0f, 75.0f);

/// The scene `lamps` with only some of its lights and lanterns: those closest to the camera's
/// target. A single light is a point light.
Scene thinned(std::size_t lights, std::size_t lanterns) {
  Scene scene = value_or_throw(scenes::make("lamps"));
  if (lights == 1)
    std::erase_if(scene.lights, [](const Light& light) { return light.type == Light::Type::spot; });
  std::stable_sort(scene.lights.begin(), scene.lights.end(), [](const Light& a, const Light& b) {
    return glm::distance(a.position_ws, kMiddle) < glm::distance(b.position_ws, kMiddle);
  });
  scene.lights.resize(lights);
  std::vector<Instance> others, lamps;
  for (Instance& instance : scene.instances) {
    (instance.name.starts_with("lantern") ? lamps : others).push_back(std::move(instance));
  }
  std::stable_sort(lamps.begin(), lamps.end(), [](const Instance& a, const Instance& b) {
    return glm::distance(glm::vec3(a.world_from_object[3]), kMiddle) <
           glm::distance(glm::vec3(b.world_from_object[3]), kMiddle);
  });
  lamps.resize(lanterns);
  others.insert(others.end(), lamps.begin(), lamps.end());
  scene.instances = std::move(others);
  return scene;
}

/// One emissive triangle, above the street before the camera.
Scene with_one_triangle() {
  Scene scene = thinned(0, 1);
  Mesh mesh = scene.meshes[scene.instances.back().mesh];
  mesh.triangles.resize(1);
  scene.meshes[scene.instances.back().mesh] = std::move(mesh);
  scene.instances.back().world_from_object[3] = glm::vec4(kMiddle, 1.0f);
  return scene;
}

struct Stage {
  explicit Stage(Scene made) : scene(std::move(made)), world(scene) {
    std::vector<Ray> rays;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      rays.push_back(camera_ray(scene.cameras[0], kWidth, kHeight,
                                static_cast<float>(i % kWidth) + 0.5f,
                                static_cast<float>(i / kWidth) + 0.5f));
    }
    std::vector<Hit> hits(rays.size());
    tracer_of(world).closest_hits(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].missed()) continue;
      const Surface s = surface_at(scene, rays[i], hits[i]);
      if (s.emission != glm::vec3(0.0f)) continue;
      points.push_back({{s.position_ws, s.normal_ws, s.geometric_normal_ws}, i});
    }
  }
  Scene scene;
  World world;
  std::vector<DirectLightQuery> points;
};

using Estimator = std::function<void(std::uint32_t round, std::span<glm::vec3>)>;

Estimator by_tree(const Stage& stage, int samples) {
  auto scratch = std::make_shared<ShadeHitsScratch>();
  return [&stage, samples, scratch](std::uint32_t round, std::span<glm::vec3> out) {
    ShadeHitsSettings settings;
    settings.emissive_samples = samples;
    settings.salt = round;
    direct_irradiance(stage.world, stage.points, settings, *scratch, out);
  };
}

double median_ms(const Stage& stage, const Estimator& estimate, int repetitions) {
  std::vector<glm::vec3> out(stage.points.size());
  Median ms;
  for (int i = 0; i < repetitions; ++i) {
    // Processor time, which other programs do not affect; only one thread runs
    const std::clock_t begin = std::clock();
    estimate(static_cast<std::uint32_t>(i), out);
    ms.add(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return ms.value();
}

struct Noise {
  double mean = 0.0;      ///< Of all points [W/m^2], luminance.
  double variance = 0.0;  ///< Of one round, mean over the points.
};

Noise noise_of(const Stage& stage, const Estimator& estimate) {
  std::vector<glm::vec3> out(stage.points.size());
  std::vector<double> sums(out.size()), squares(out.size());
  for (std::uint32_t round = 0; round < kRounds; ++round) {
    estimate(1000 + round, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double e = luminance(out[i]);
      sums[i] += e;
      squares[i] += e * e;
    }
  }
  Noise noise;
  const auto count = static_cast<double>(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    noise.mean += sums[i] / kRounds / count;
    noise.variance += (squares[i] - sums[i] * sums[i] / kRounds) / (kRounds - 1) / count;
  }
  return noise;
}

void measure_cost(int repetitions) {
  std::printf(
      "| lights, emissive triangles | samples | ms | over the first |\n|---|---|---|---|\n");
  for (const int samples : {1, 4}) {
    double first = 0.0;
    for (const std::size_t lights : {1, 4, 8, 9, 16, 100, 1000}) {
      const Stage stage(thinned(lights, 0));
      const double ms = median_ms(stage, by_tree(stage, samples), repetitions);
      if (lights == 1) first = ms;
      std::printf("| %zu, 0 | %d | %.2f | %.2f |\n", lights, samples, ms, ms / first);
    }
    for (const std::size_t lanterns : {0, 1, 10, 100, 1000}) {
      const Stage stage(lanterns == 0 ? with_one_triangle() : thinned(0, lanterns));
      const double ms = median_ms(stage, by_tree(stage, samples), repetitions);
      if (lanterns == 0) first = ms;
      std::printf("| 0, %zu | %d | %.2f | %.2f |\n", emissive_of(stage.world).size(), samples, ms,
                  ms / first);
    }
  }
}

void measure_noise(int repetitions) {
  std::printf(
      "\n| lamps | ms | mean [W/m^2] | relative RMSE of a point | variance x time over drawing by "
      "power |\n"
      "|---|---|---|---|---|\n");
  const Stage stage(thinned(1000, 1000));
  const ByPower power(stage.world);
  const Estimator plain = [&](std::uint32_t round, std::span<glm::vec3> out) {
    power.direct_irradiance(stage.points, round, out);
  };
  double plain_cost = 0.0;
  const auto row = [&](const char* name, const Estimator& estimate) {
    const double ms = median_ms(stage, estimate, repetitions);
    const Noise noise = noise_of(stage, estimate);
    const double cost = noise.variance * ms;
    if (plain_cost == 0.0) plain_cost = cost;
    std::printf("| %s | %.2f | %.4f | %.3f | %.5f |\n", name, ms, noise.mean,
                std::sqrt(noise.variance) / noise.mean, cost / plain_cost);
  };
  row("by power, 1 ray", plain);
  row("by the tree, 1 ray", by_tree(stage, 1));
  row("by the tree, 4 rays", by_tree(stage, 4));
}

}  // namespace
}  // namespace lambent::bench

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 9;
  if (repetitions < 1) {
    std::fprintf(stderr, "lambent_lights: repetitions must be at least 1\n");
    return 2;
  }
  try {
    lambent::bench::measure_cost(repetitions);
    lambent::bench::measure_noise(repetitions);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lambent_lights: %s\n", error.what());
    return 1;
  }
  return 0;
}
