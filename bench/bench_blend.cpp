// SPDX-License-Identifier: Apache-2.0
// The matrix product from rays to texels, for all probes of a field.
#include "bench/workload.h"
#include "core/parallel.h"
#include "field/field_access.h"
#include "field/probes/probe_store.h"
#include "field/transport/blend.h"
#include "field/transport/distances.h"
#include "field/transport/surfels.h"

namespace lambent::bench {
namespace {

constexpr int kBlendRepetitions = 15;
constexpr std::size_t kProbesPerTask = 16;

std::vector<vec3> directions_of(const Workload& work) {
  const FieldSettings& settings = work.field.settings();
  return probe_ray_directions(settings.rays_per_probe, 0, settings.seed);
}

/// Irradiance: only the product.
void blend_irradiance(benchmark::State& state) {
  const Workload& work = workload();
  const BlendMatrix blend(work.field.settings().irradiance_texels, 1.0f, directions_of(work));
  const auto probes = static_cast<std::size_t>(work.field.probes());
  const std::size_t values = 4 * static_cast<std::size_t>(blend.rays());
  const std::vector<float> radiance(values * probes, 0.7f);
  std::vector<float> sums(4 * probes * blend.texels());
  Median ms;
  for (auto _ : state) {
    const double elapsed = time_ms([&] {
      parallel_chunks(probes, kProbesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t probe = begin; probe < end; ++probe) {
          blend.apply4(&radiance[probe * values], &sums[4 * probe * blend.texels()]);
        }
      });
    });
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
  }
  benchmark::DoNotOptimize(sums.data());
  state.counters["median_ms"] = ms.value();
  state.counters["probes"] = static_cast<double>(probes);
}

/// Distances: the product, and storing the result.
void blend_distances_of_all_probes(benchmark::State& state) {
  const Workload& work = workload();
  const FieldSettings& settings = work.field.settings();
  const TraceGroup traced = trace_all_probes(work);
  const DistanceBlend blend(settings, traced.rays->directions);
  const std::vector<float> blend_weights(traced.probes.size(), 0.1f);
  ProbeStore store(store_of(work.field).grid(0), settings);
  const SolidSides sides = solid_sides_by_winding(work.scene);
  Median ms;
  for (auto _ : state) {
    const double elapsed =
        time_ms([&] { blend_distances(sides, blend, traced, blend_weights, 1u, store); });
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
  }
  state.counters["median_ms"] = ms.value();
  state.counters["probes"] = static_cast<double>(store.probes());
}

BENCHMARK(blend_irradiance)
    ->UseManualTime()
    ->Iterations(kBlendRepetitions)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(blend_distances_of_all_probes)
    ->UseManualTime()
    ->Iterations(kBlendRepetitions)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
