// SPDX-License-Identifier: Apache-2.0
// Indirect light from reflective shadow maps, compared in one run: the plain gather, the
// interleaved one with and without restructuring, and the cost of each stage.
// LAMBENT_BENCH_SCENE=cornell-spot or Sponza's path; the picture has 1920 x 1080 pixels unless
// LAMBENT_BENCH_RSM_SIZE=WxH says otherwise.
#include <array>
#include <map>

#include "bench/rsm_workload.h"
#include "bench/stage.h"
#include "bench/workload.h"

namespace lambent::bench {
namespace {

constexpr int kRsmRepetitions = 7;

/// Times of one variant; buffers are reused from frame to frame, as in an engine.
struct Variant {
  explicit Variant(const RsmSettings& chosen) : settings(chosen) {}
  void run(const RsmWorkload& work) {
    const auto done = gatherer.gather(workload().world, work.maps, work.view(), settings, result);
    value_or_throw(done);
    double sum = 0.0;
    for (const PassTime& pass : result.passes) {
      passes[pass.name].add(pass.ms);
      // Choosing texels is the same for all variants, and counts as part of rendering the maps
      if (pass.name != "rsm.choose") sum += pass.ms;
    }
    total.add(sum);
  }
  /// Includes restructuring the picture.
  double gathering() const { return passes.at("rsm.gather").value(); }
  RsmSettings settings;
  RsmGatherer gatherer;
  RsmIrradiance result;
  std::map<std::string, Median> passes;
  Median total;
};

/// The plain gather and the interleaved one in each layout. The first run of each is not counted,
/// since it allocates the buffers.
void rsm(benchmark::State& state) {
  const RsmWorkload& work = rsm_workload();
  Variant plain(plain_gather()), restructured(with_layout(RsmLayout::restructured)),
      sub_maps(with_layout(RsmLayout::sub_maps)), full(with_layout(RsmLayout::full));
  const std::array<Variant*, 4> all = {&plain, &restructured, &sub_maps, &full};
  for (Variant* variant : all) {
    variant->run(work);
    variant->passes.clear();
    variant->total = {};
  }
  for (auto _ : state) {
    const double ms = time_ms([&] {
      for (Variant* variant : all) variant->run(work);
    });
    state.SetIterationTime(ms * 1e-3);
  }
  for (const auto& [name, ms] : restructured.passes) state.counters[name + "_ms"] = ms.value();
  state.counters["plain_ms"] = plain.total.value();
  state.counters["interleaved_ms"] = restructured.total.value();
  state.counters["plain_over_interleaved"] = plain.total.value() / restructured.total.value();
  state.counters["gather_restructured_ms"] = restructured.gathering();
  state.counters["gather_sub_maps_ms"] = sub_maps.gathering();
  state.counters["gather_full_ms"] = full.gathering();
  state.counters["full_over_restructured"] = full.gathering() / restructured.gathering();
}

/// Total time of one variant of the settings, for the plot.
void measure(benchmark::State& state, const RsmWorkload& work, const RsmSettings& settings) {
  Variant variant(settings);
  variant.run(work);
  variant.total = {};
  for (auto _ : state) {
    state.SetIterationTime(time_ms([&] { variant.run(work); }) * 1e-3);
  }
  state.counters["median_ms"] = variant.total.value();
}

void rsm_by_height(benchmark::State& state) {
  const int height = static_cast<int>(state.range(0));
  measure(state, RsmWorkload({height * 16 / 9, height}), {});
}

void rsm_by_texels(benchmark::State& state) {
  RsmSettings settings;
  settings.texels = static_cast<int>(state.range(0));
  measure(state, rsm_workload(), settings);
}

void rsm_by_sub_images(benchmark::State& state) {
  RsmSettings settings;
  settings.sub_images = settings.sub_maps = static_cast<int>(state.range(0));
  measure(state, rsm_workload(), settings);
}

BENCHMARK(rsm)->UseManualTime()->Iterations(kRsmRepetitions)->Unit(benchmark::kMillisecond);
BENCHMARK(rsm_by_height)
    ->UseManualTime()
    ->Iterations(kRsmRepetitions)
    ->Arg(270)
    ->Arg(540)
    ->Arg(1080)
    ->Arg(2160)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(rsm_by_texels)
    ->UseManualTime()
    ->Iterations(kRsmRepetitions)
    ->RangeMultiplier(2)
    ->Range(256, 8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(rsm_by_sub_images)
    ->UseManualTime()
    ->Iterations(kRsmRepetitions)
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Unit(benchmark::kMillisecond);
}  // namespace
}  // namespace lambent::bench
