// SPDX-License-Identifier: Apache-2.0
// Looking the field up at every pixel of a picture, beside tracing as many primary rays.
#include "bench/workload.h"

namespace lambent::bench {
namespace {

constexpr int kRepetitions = 31;

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

BENCHMARK(lookup)->UseManualTime()->Iterations(kRepetitions)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
