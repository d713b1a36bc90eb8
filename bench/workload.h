// SPDX-License-Identifier: Apache-2.0
// The workload of all benches: a scene, a field with default settings after some updates, and the
// rays of its updates.
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "bench/median.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"
#include "lambent/scene.h"
#include "lambent/world.h"
#include "raytracing/raytracer.h"

namespace lambent::bench {

// Size of the picture for measurements of primary rays and lookups.
inline constexpr int kWidth = 1280, kHeight = 720;

struct Workload {
  Workload(std::string scene_name, Scene made);

  std::string name;
  Scene scene;
  World world;
  Camera camera;
  IrradianceField field;
};

/// The atrium, or the scene that the environment variable LAMBENT_BENCH_SCENE names. If it has no
/// light, a sun and a sky are added. Throws where it cannot be read.
Workload& workload();

/// The first update's rays of all probes, traced.
TraceGroup trace_all_probes(const Workload& work);

/// Rays, grouped as the passes trace them.
struct UpdateRays {
  std::vector<Ray> probe_rays;
  std::vector<Ray> shadow_rays;
};

/// Exactly the closest-hit and shadow rays that update number `update` of the field traces.
UpdateRays record_update_rays(const Workload& work, int update);

/// Primary rays through the centre of each pixel of the picture.
std::vector<Ray> primary_rays(const Workload& work);

/// The points that the camera sees, as queries of the field.
std::vector<FieldQuery> pixel_queries(const Workload& work);

/// Wall-clock time [ms] of tracing alone, on all cores.
double time_closest_hits(const Workload& work, std::span<const Ray> rays, std::vector<Hit>& hits);
double time_occlusions(const Workload& work, std::span<const Ray> rays,
                       std::vector<std::uint8_t>& occluded);

/// Wall-clock time [ms] of a call.
template <class Body>
double time_ms(Body body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace lambent::bench
