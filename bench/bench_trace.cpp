// SPDX-License-Identifier: Apache-2.0
// Tracing alone: the lower bound to which passes are compared.
#include "bench/workload.h"

namespace lambent::bench {
namespace {

constexpr int kTraceRepetitions = 9;

/// Runs `trace(rays)`, which returns milliseconds, and reports time and speed.
template <class Trace>
void report(benchmark::State& state, std::size_t rays, Trace trace) {
  Median ms;
  for (auto _ : state) {
    const double elapsed = trace();
    ms.add(elapsed);
    state.SetIterationTime(elapsed * 1e-3);
  }
  state.counters["median_ms"] = ms.value();
  state.counters["rays"] = static_cast<double>(rays);
  state.counters["mrays_per_s"] = static_cast<double>(rays) * 1e-3 / ms.value();
}

void trace_probe_rays(benchmark::State& state) {
  const UpdateRays rays = record_update_rays(workload(), 0);
  std::vector<Hit> hits;
  report(state, rays.probe_rays.size(),
         [&] { return time_closest_hits(workload(), rays.probe_rays, hits); });
}

void trace_shadow_rays(benchmark::State& state) {
  const UpdateRays rays = record_update_rays(workload(), 0);
  std::vector<std::uint8_t> occluded;
  report(state, rays.shadow_rays.size(),
         [&] { return time_occlusions(workload(), rays.shadow_rays, occluded); });
}

void trace_primary_rays(benchmark::State& state) {
  const std::vector<Ray> rays = primary_rays(workload());
  std::vector<Hit> hits;
  report(state, rays.size(), [&] { return time_closest_hits(workload(), rays, hits); });
}

BENCHMARK(trace_probe_rays)
    ->UseManualTime()
    ->Iterations(kTraceRepetitions)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(trace_shadow_rays)
    ->UseManualTime()
    ->Iterations(kTraceRepetitions)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(trace_primary_rays)
    ->UseManualTime()
    ->Iterations(kTraceRepetitions)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
