// SPDX-License-Identifier: Apache-2.0
// The passes of a whole frame.
#include <map>

#include "bench/stage.h"
#include "bench/workload.h"
#include "lambent/renderer.h"

namespace lambent::bench {
namespace {

constexpr int kFrameRepetitions = 5;

void frame(benchmark::State& state) {
  const Workload& work = workload();
  FrameSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  Median ms;
  std::map<std::string, Median> passes;
  Renderer renderer(work.world, {.field = &work.field});
  RenderedFrame rendered;
  for (auto _ : state) {
    Expected<void> done;
    const double elapsed =
        time_ms([&] { done = renderer.render(work.camera, settings, rendered); });
    value_or_throw(done);
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
    for (const PassTime& pass : rendered.passes) passes[pass.name].add(pass.ms);
  }
  state.counters["median_ms"] = ms.value();
  for (const auto& [name, median] : passes) state.counters[name + "_ms"] = median.value();
}

BENCHMARK(frame)->UseManualTime()->Iterations(kFrameRepetitions)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
