// SPDX-License-Identifier: Apache-2.0
// From hits to surfels: surfaces, direct light with its shadow rays, and lookup weights.
#include "bench/workload.h"
#include "field/field_access.h"
#include "field/probes/probe_store.h"
#include "field/transport/surfels.h"

namespace lambent::bench {
namespace {

constexpr int kShadeRepetitions = 9;

const SolidSides& solid_sides() {
  static const SolidSides sides = solid_sides_by_winding(workload().scene);
  return sides;
}

void shade(benchmark::State& state) {
  const Workload& work = workload();
  const TraceGroup traced = trace_all_probes(work);
  const UpdateRays rays = record_update_rays(work, 0);
  std::vector<std::uint8_t> occluded;
  std::vector<ProbeTrace> traces(traced.probes.size());
  Median ms, ratio;
  for (auto _ : state) {
    const double shadows = time_occlusions(work, rays.shadow_rays, occluded);
    const double elapsed = time_ms([&] {
      shade_surfels(work.world, solid_sides(), store_of(work.field), traced, work.field.settings(),
                    traces);
    });
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
    ratio.add(elapsed / shadows);
  }
  state.counters["median_ms"] = ms.value();
  state.counters["ratio_to_shadow_tracing"] = ratio.value();
  state.counters["surfels"] = static_cast<double>(traced.hits.size());
}

void find_lookups(benchmark::State& state) {
  const Workload& work = workload();
  const TraceGroup traced = trace_all_probes(work);
  std::vector<ProbeTrace> traces(traced.probes.size());
  shade_surfels(work.world, solid_sides(), store_of(work.field), traced, work.field.settings(),
                traces);
  Median ms;
  for (auto _ : state) {
    const double elapsed =
        time_ms([&] { find_surfel_lookups(store_of(work.field), {}, traced.probes, traces); });
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
  }
  state.counters["median_ms"] = ms.value();
  state.counters["surfels"] = static_cast<double>(traced.hits.size());
}

BENCHMARK(shade)->UseManualTime()->Iterations(kShadeRepetitions)->Unit(benchmark::kMillisecond);
BENCHMARK(find_lookups)
    ->UseManualTime()
    ->Iterations(kShadeRepetitions)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
