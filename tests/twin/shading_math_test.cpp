// SPDX-License-Identifier: Apache-2.0
// The formulas of shading, in C++ and on the device.
#include "twin/shading_math.h"

#include <cmath>
#include <cstring>

#include "shaders/shading_math_comp.h"
#include "support/vulkan_device.h"
#include "vulkan/buffer.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using ShadingOnDevice = test::OnDevice;

constexpr std::uint32_t kCount = 4096;
// Devices may fuse products into sums, and their sines, cosines and inverse cosines may be off by
// 2^-11 (Vulkan specification, "Precision and Operation of SPIR-V Instructions"); differences of
// near numbers magnify both, which few of so many random inputs see.
constexpr float kTolerance = 4e-3f;
constexpr float kCommonTolerance = 2e-5f;
constexpr double kRareShare = 0.02;

std::vector<ShadingMath> on_device(const vulkan::Device& device) {
  const vulkan::Buffer results(device, kCount * sizeof(ShadingMath), vulkan::Memory::device,
                               "shading math");
  const vulkan::Kernel kernel(device, shaders::shading_math_comp(), "shading math");
  const ShadingMathArguments arguments = {{results.address()}, kCount, 0};
  device.run([&](vulkan::Recorder& to) { to.run(kernel, arguments, kCount); });
  return vulkan::download<ShadingMath>(device, results);
}

TEST_F(ShadingOnDevice, ComputesTheSameNumbers) {
  constexpr std::size_t kNumbers = sizeof(ShadingNumbers) / sizeof(float);
  const std::vector<ShadingMath> device_results = on_device(device());
  std::vector<std::size_t> apart(kNumbers, 0);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const ShadingNumbers here = evaluate_shading_math(i).numbers;
    float expected[kNumbers], actual[kNumbers];
    std::memcpy(expected, &here, sizeof(here));
    std::memcpy(actual, &device_results[i].numbers, sizeof(here));
    for (std::size_t k = 0; k < kNumbers; ++k) {
      const float scale = 1.0f + std::fabs(expected[k]);
      ASSERT_NEAR(actual[k], expected[k], kTolerance * scale) << "number " << k << " of " << i;
      if (std::fabs(actual[k] - expected[k]) > kCommonTolerance * scale) ++apart[k];
    }
  }
  for (std::size_t k = 0; k < kNumbers; ++k) {
    EXPECT_LE(static_cast<double>(apart[k]), kRareShare * kCount) << "number " << k;
  }
}

TEST_F(ShadingOnDevice, DecidesTheSame) {
  constexpr std::size_t kWords = sizeof(ShadingDecisions) / sizeof(std::uint32_t);
  const std::vector<ShadingMath> device_results = on_device(device());
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const ShadingDecisions here = evaluate_shading_math(i).decisions;
    std::int32_t expected[kWords], actual[kWords];
    std::memcpy(expected, &here, sizeof(here));
    std::memcpy(actual, &device_results[i].decisions, sizeof(here));
    for (std::size_t k = 0; k < kWords; ++k) {
      ASSERT_EQ(actual[k], expected[k]) << "word " << k << " of " << i;
    }
  }
}

}  // namespace
}  // namespace lambent
