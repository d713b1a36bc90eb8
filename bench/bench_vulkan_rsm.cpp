// SPDX-License-Identifier: Apache-2.0
// The interleaved gather on a Vulkan device, timed by its timestamps and compared to the plain
// gather, and to the same interleaved pattern read from full-resolution buffers. The scene and size
// are those of bench_rsm.cpp.
#include <array>
#include <map>

#include "bench/rsm_workload.h"
#include "bench/workload.h"
#include "lambent/vulkan.h"
#include "rsm/maps/lights.h"
#include "rsm/vulkan/gather_vulkan.h"

namespace lambent::bench {
namespace {

constexpr int kVulkanRsmRepetitions = 7;
constexpr std::uint32_t kTimedPasses = 8;

/// Times of one variant; its texels are chosen once.
class VariantOnDevice {
 public:
  VariantOnDevice(const vulkan::Device& device, const RsmWorkload& work,
                  const RsmSettings& settings)
      : device_(device), settings_(settings), gatherer_(device), timestamps_(device, kTimedPasses) {
    gatherer_.set_lights(choose_lights(work.maps, work.view(), settings), settings);
  }
  void run(const UploadedRsmView& view) {
    device_.run([&](vulkan::Recorder& untimed) {
      vulkan::Recorder recorder(device_, untimed.commands(), &timestamps_);
      gatherer_.record(recorder, view.on_device, settings_);
    });
    double sum = 0.0;
    for (const vulkan::DevicePassTime& pass : timestamps_.read()) {
      passes[pass.name].add(pass.ms);
      sum += pass.ms;
    }
    total.add(sum);
  }
  /// Discards times so far, which include filling caches and creating buffers.
  void forget() {
    passes.clear();
    total = {};
  }
  double gathering() const { return passes.at("rsm.gather").value(); }

  std::map<std::string, Median> passes;
  Median total;

 private:
  const vulkan::Device& device_;
  RsmSettings settings_;
  RsmGathererVulkan gatherer_;
  vulkan::Timestamps timestamps_;
};

void vulkan_rsm(benchmark::State& state) {
  const auto device = vulkan::open_device();
  if (!device) return state.SkipWithError(device.error().message().c_str());
  const RsmWorkload& work = rsm_workload();
  const UploadedRsmView view(**device, work.view());
  VariantOnDevice plain(**device, work, plain_gather());
  VariantOnDevice restructured(**device, work, with_layout(RsmLayout::restructured));
  VariantOnDevice full(**device, work, with_layout(RsmLayout::full));
  const std::array<VariantOnDevice*, 3> all = {&plain, &restructured, &full};
  for (VariantOnDevice* variant : all) {
    variant->run(view);
    variant->forget();
  }
  for (auto _ : state) {
    const double ms = time_ms([&] {
      for (VariantOnDevice* variant : all) variant->run(view);
    });
    state.SetIterationTime(ms * 1e-3);
  }
  if (restructured.passes.empty()) return state.SkipWithError("the device has no timestamps");
  state.SetLabel(description(**device).name);
  for (const auto& [name, ms] : restructured.passes) state.counters[name + "_ms"] = ms.value();
  state.counters["plain_ms"] = plain.total.value();
  state.counters["interleaved_ms"] = restructured.total.value();
  state.counters["plain_over_interleaved"] = plain.total.value() / restructured.total.value();
  state.counters["gather_full_ms"] = full.gathering();
  state.counters["full_over_restructured"] = full.gathering() / restructured.gathering();
}

BENCHMARK(vulkan_rsm)
    ->UseManualTime()
    ->Iterations(kVulkanRsmRepetitions)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lambent::bench
