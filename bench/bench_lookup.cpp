// SPDX-License-Identifier: Apache-2.0
// Lookups of the field at every pixel of a picture, compared to tracing as many primary rays.
#include <atomic>
#include <numeric>

#include "bench/workload.h"
#include "core/parallel.h"
#include "field/field_access.h"
#include "field/lookup/lookup_volumes.h"
#include "raytracing/world_access.h"

namespace lambent::bench {
namespace {

constexpr int kLookupRepetitions = 31;
constexpr std::size_t kQueriesPerTask = 4096;

void lookup(benchmark::State& state) {
  const Workload& work = workload();
  const std::vector<Ray> rays = primary_rays(work);
  const std::vector<FieldQuery> queries = pixel_queries(work);
  std::vector<glm::vec3> irradiance(queries.size());
  std::vector<Hit> hits;
  Median lookup_ms, tracing_ms, ratio;
  for (auto _ : state) {
    const double before = time_closest_hits(work, rays, hits);
    const double elapsed = time_ms([&] { work.field.irradiance(queries, irradiance); });
    const double tracing = 0.5 * (before + time_closest_hits(work, rays, hits));
    state.SetIterationTime(elapsed * 1e-3);
    lookup_ms.add(elapsed);
    tracing_ms.add(tracing);
    ratio.add(elapsed / tracing);
  }
  state.counters["median_ms"] = lookup_ms.value();
  state.counters["tracing_ms"] = tracing_ms.value();
  state.counters["ratio_to_tracing"] = ratio.value();
  state.counters["lookups"] = static_cast<double>(queries.size());
}

BENCHMARK(lookup)->UseManualTime()->Iterations(kLookupRepetitions)->Unit(benchmark::kMillisecond);

/// Lookups with hybrid visibility, compared to the plain lookup.
void lookup_hybrid(benchmark::State& state) {
  const Workload& work = workload();
  const ProbeStore& store = store_of(work.field);
  const RayTracer& tracer = tracer_of(work.world);
  std::vector<int> probes(store.probes());
  std::iota(probes.begin(), probes.end(), 0);
  CellVisibility cell_visibility(store.probes());
  cell_visibility.update(tracer, store, probes);
  const std::vector<FieldQuery> queries = pixel_queries(work);
  std::vector<glm::vec3> irradiance(queries.size());
  std::atomic<std::uint64_t> rays = 0;
  const auto look_up = [&](Visibility mode) {
    return time_ms([&] {
      parallel_chunks(queries.size(), kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
        rays += lookup_irradiance(store, {mode, &tracer, &cell_visibility},
                                  std::span(queries).subspan(begin, end - begin),
                                  std::span(irradiance).subspan(begin, end - begin));
      });
    });
  };
  Median hybrid_ms, ratio;
  for (auto _ : state) {
    const double before = look_up(Visibility::moments);
    rays = 0;
    const double elapsed = look_up(Visibility::hybrid);
    const double plain = 0.5 * (before + look_up(Visibility::moments));
    state.SetIterationTime(elapsed * 1e-3);
    hybrid_ms.add(elapsed);
    ratio.add(elapsed / plain);
  }
  state.counters["median_ms"] = hybrid_ms.value();
  state.counters["ratio_to_moments"] = ratio.value();
  state.counters["rays_per_lookup"] =
      static_cast<double>(rays) / static_cast<double>(queries.size());
}

BENCHMARK(lookup_hybrid)
    ->UseManualTime()
    ->Iterations(kLookupRepetitions)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
