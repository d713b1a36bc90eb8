// SPDX-License-Identifier: Apache-2.0
// From hits to surfels: surfaces, direct light with its shadow rays, and where surfels look the
// field up.
#include "bench/workload.h"
#include "field/blend.h"
#include "field/probe_store.h"
#include "field/surfels.h"

namespace lambent::bench {
namespace {

constexpr int kRepetitions = 9;

struct Hits {
  explicit Hits(const Workload& work)
      : directions(probe_ray_directions(work.field.settings().rays_per_probe, 0,
                                        work.field.settings().seed)) {
    trace_probe_rays(work.world.tracer(), work.field.store().grid(), directions, hits);
  }
  std::vector<vec3> directions;
  std::vector<Hit> hits;
};

void shade(benchmark::State& state) {
  const Workload& work = workload();
  const Hits traced(work);
  const UpdateRays rays = record_update_rays(work, 0);
  std::vector<std::uint8_t> occluded;
  Surfels surfels;
  Median ms, ratio;
  for (auto _ : state) {
    const double shadows = time_occlusions(work, rays.shadow_rays, occluded);
    const double elapsed = time_ms([&] {
      shade_surfels(work.world, work.field.store().grid(), traced.directions, traced.hits,
                    work.field.settings(), 0u, surfels);
    });
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
    ratio.add(elapsed / shadows);
  }
  state.counters["median_ms"] = ms.value();
  state.counters["ratio_to_shadow_tracing"] = ratio.value();
  state.counters["surfels"] = static_cast<double>(surfels.size());
}

void find_lookups(benchmark::State& state) {
  const Workload& work = workload();
  const Hits traced(work);
  Surfels surfels;
  shade_surfels(work.world, work.field.store().grid(), traced.directions, traced.hits,
                work.field.settings(), 0u, surfels);
  Median ms;
  for (auto _ : state) {
    const double elapsed =
        time_ms([&] { find_surfel_lookups(work.field.store(), traced.directions, surfels); });
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
  }
  state.counters["median_ms"] = ms.value();
  state.counters["surfels"] = static_cast<double>(surfels.size());
}

BENCHMARK(shade)->UseManualTime()->Iterations(kRepetitions)->Unit(benchmark::kMillisecond);
BENCHMARK(find_lookups)->UseManualTime()->Iterations(kRepetitions)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
