// SPDX-License-Identifier: Apache-2.0
// Measures the passes of a field and of frames on a Vulkan device, and compares them to results of
// the CPU backend, possibly from another machine.
#include <cstdio>
#include <exception>
#include <memory>

#include "bench/gpu/measure.h"
#include "bench/gpu/options.h"
#include "bench/gpu/results.h"
#include "lambent/vulkan.h"
#include "scene/prepared.h"

namespace lambent::bench {
namespace {

constexpr int kFailed = 1;
constexpr int kBadUsageOrInput = 2;

int report(const Error& error) {
  std::fprintf(stderr, "lambent_gpu_bench: %s\n", error.message().c_str());
  return error.kind == Error::Kind::bad_input ? kBadUsageOrInput : kFailed;
}

/// Compares each result with the expected one of that name. Returns the number that differ by more
/// than the tolerance.
int compare(const std::vector<Result>& found, const std::vector<Result>& expected) {
  int bad = 0;
  std::printf("\n| result | relative RMSE | bar |\n|---|---|---|\n");
  for (const Result& result : found) {
    double rmse = relative_rmse(result.values, {});
    for (const Result& candidate : expected) {
      if (candidate.name == result.name) rmse = relative_rmse(result.values, candidate.values);
    }
    const bool good = rmse <= kTolerance;
    std::printf("| %s | %.3g %% | <= %g %%%s |\n", result.name.c_str(), 100.0 * rmse,
                100.0 * kTolerance, good ? "" : ", missed");
    bad += good ? 0 : 1;
  }
  return bad + (found.size() == expected.size() ? 0 : 1);
}

int run(const Options& options) {
  Expected<Scene> scene = load_prepared(options.scene);
  if (!scene) return report(scene.error());
  if (scene->cameras.empty()) return report({options.scene, "cameras", "there is none"});
  if (!options.save.empty()) {
    const auto saved = save_results(find_results(World(*scene)), options.save);
    return saved ? 0 : report(saved.error());
  }

  const auto device = vulkan::open_device({options.device, options.validation});
  if (!device) return report(device.error());
  const vulkan::DeviceDescription& about = vulkan::description(**device);
  std::printf("%s, %s; %zu triangles; medians of %d frames\n", about.name.c_str(),
              about.driver.c_str(), triangle_count(*scene), options.frames);
  const World world(*scene, *device);
  int bad = 0;
  if (!options.check.empty()) {
    const auto expected = load_results(options.check);
    if (!expected) return report(expected.error());
    bad = compare(find_results(world), *expected);
  }
  const std::vector<Row> rows = measure(world, options);
  std::printf("\n| what | | | bar |\n|---|---|---|---|\n");
  for (const Row& row : rows) {
    std::printf("| %s | %.4g | %s | %s |\n", row.what.c_str(), row.value, row.unit.c_str(),
                row.bar.c_str());
  }
  for (const std::string& message : vulkan::validation_messages(**device)) {
    std::fprintf(stderr, "validation: %s\n", message.c_str());
    ++bad;
  }
  if (bad != 0) std::fprintf(stderr, "lambent_gpu_bench: %d checks failed\n", bad);
  return bad == 0 ? 0 : kFailed;
}

}  // namespace
}  // namespace lambent::bench

int main(int argc, char** argv) {
  const auto options = lambent::bench::parse(argc, argv);
  if (!options) {
    std::fprintf(stderr, "lambent_gpu_bench: %s\n%s", options.error().message().c_str(),
                 lambent::bench::kUsage);
    return lambent::bench::kBadUsageOrInput;
  }
  try {
    return lambent::bench::run(*options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lambent_gpu_bench: %s\n", error.what());
    return lambent::bench::kFailed;
  }
}
