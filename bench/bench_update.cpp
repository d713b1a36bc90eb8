// SPDX-License-Identifier: Apache-2.0
// A full update of the field, compared to tracing exactly its rays. Both alternate, so that noise
// of the machine affects both; ratios are medians over repetitions.
#include "bench/workload.h"

namespace lambent::bench {
namespace {

constexpr int kUpdateRepetitions = 15;

double time_tracing(const Workload& work, const UpdateRays& rays, std::vector<Hit>& hits,
                    std::vector<std::uint8_t>& occluded) {
  return time_closest_hits(work, rays.probe_rays, hits) +
         time_occlusions(work, rays.shadow_rays, occluded);
}

void update(benchmark::State& state) {
  Workload& work = workload();
  std::vector<Hit> hits;
  std::vector<std::uint8_t> occluded;
  Median update_ms, tracing_ms, ratio, blend, solve_bounces, trace, shade, corrections;
  Median solve_iterations;
  UpdateStatistics last;
  for (auto _ : state) {
    const UpdateRays rays = record_update_rays(work, work.field.updates());
    const double before = time_tracing(work, rays, hits, occluded);
    const double elapsed = time_ms([&] { last = work.field.update(work.world); });
    const double tracing = 0.5 * (before + time_tracing(work, rays, hits, occluded));
    state.SetIterationTime(elapsed * 1e-3);
    if (rays.probe_rays.size() != last.probe_rays || rays.shadow_rays.size() != last.shadow_rays) {
      state.SkipWithError("the recorded rays are not those of the update");
      break;
    }
    update_ms.add(elapsed);
    tracing_ms.add(tracing);
    ratio.add(elapsed / tracing);
    blend.add((last.ms("blend_distances") + last.ms("store")) / tracing);
    solve_bounces.add(last.ms("solve") / last.solve_iterations / tracing);
    trace.add(last.ms("trace") / tracing);
    shade.add((last.ms("shade") + last.ms("lookups")) / tracing);
    corrections.add(last.ms("corrections") / tracing);
    solve_iterations.add(last.solve_iterations);
  }
  state.counters["median_ms"] = update_ms.value();
  state.counters["tracing_ms"] = tracing_ms.value();
  state.counters["ratio_to_tracing"] = ratio.value();
  state.counters["trace_share_of_tracing"] = trace.value();
  state.counters["shade_share_of_tracing"] = shade.value();
  state.counters["blend_share_of_tracing"] = blend.value();
  state.counters["solve_iteration_share_of_tracing"] = solve_bounces.value();
  state.counters["corrections_share_of_tracing"] = corrections.value();
  state.counters["solve_iterations"] = solve_iterations.value();
  state.counters["probe_rays"] = static_cast<double>(last.probe_rays);
  state.counters["shadow_rays"] = static_cast<double>(last.shadow_rays);
  state.counters["store_bytes_per_probe"] =
      static_cast<double>(work.field.store_bytes()) / work.field.probes();
}

BENCHMARK(update)->UseManualTime()->Iterations(kUpdateRepetitions)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
