// SPDX-License-Identifier: Apache-2.0
// The formulas of shading, in C++ and on the device.
#include "twin/shading_math.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "shaders/shading_math_comp.h"
#include "support/vulkan_device.h"
#include "vulkan/buffer.h"
#include "vulkan/recorder.h"

namespace lambent::shading_math_test {
namespace {

using ShadingOnDevice = test::OnDevice;

constexpr std::uint32_t kCount = 4096;
// Devices may fuse products into sums, whose differences near numbers magnify: few of so many
// random inputs see more than the common tolerance.
constexpr float kCommonTolerance = 2e-5f;
constexpr float kTolerance = 4e-3f;
constexpr double kRareShare = 0.02;
// Angles may be off by 2^-11 rad, or 4096 units in the last place of arc tangents (Vulkan
// specification, "Precision of GLSL.std.450 Instructions").
constexpr float kAngleTolerance = 2e-3f;

std::vector<ShadingMath> on_device(const vulkan::Device& device) {
  const vulkan::Buffer results(device, kCount * sizeof(ShadingMath), vulkan::Memory::device,
                               "shading math");
  const vulkan::Kernel kernel(device, shaders::shading_math_comp(), "shading math");
  const ShadingMathArguments arguments = {{results.address()}, kCount, 0};
  device.run([&](vulkan::Recorder& to) { to.run(kernel, arguments, kCount); });
  return vulkan::download<ShadingMath>(device, results);
}

template <class Words>
std::array<float, sizeof(Words) / sizeof(float)> floats_of(const Words& words) {
  return std::bit_cast<std::array<float, sizeof(Words) / sizeof(float)>>(words);
}

TEST_F(ShadingOnDevice, ComputesTheSameNumbers) {
  const std::vector<ShadingMath> device_results = on_device(device());
  std::vector<std::size_t> apart(sizeof(ShadingNumbers) / sizeof(float), 0);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto expected = floats_of(evaluate_shading_math(i).numbers);
    const auto actual = floats_of(device_results[i].numbers);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const float scale = 1.0f + std::fabs(expected[k]);
      ASSERT_NEAR(actual[k], expected[k], kTolerance * scale) << "number " << k << " of " << i;
      if (std::fabs(actual[k] - expected[k]) > kCommonTolerance * scale) ++apart[k];
    }
  }
  for (std::size_t k = 0; k < apart.size(); ++k) {
    EXPECT_LE(static_cast<double>(apart[k]), kRareShare * kCount) << "number " << k;
  }
}

TEST_F(ShadingOnDevice, FindsDirectionsAndSolidAnglesAsTheyAre) {
  const std::vector<ShadingMath> device_results = on_device(device());
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const AngleNumbers expected = evaluate_shading_math(i).angles;
    const AngleNumbers& actual = device_results[i].angles;
    // At the map's seam, u may be at either end
    const float across = std::fabs(actual.map_point.x - expected.map_point.x);
    ASSERT_LE(std::min(across, 1.0f - across), kAngleTolerance) << i;
    ASSERT_NEAR(actual.map_point.y, expected.map_point.y, kAngleTolerance) << i;
    ASSERT_LE(glm::length(actual.map_direction - expected.map_direction), kAngleTolerance) << i;
    ASSERT_NEAR(actual.solid_angle, expected.solid_angle, kAngleTolerance) << i;
  }
}

TEST_F(ShadingOnDevice, DecidesTheSame) {
  using Words = std::array<std::int32_t, sizeof(ShadingDecisions) / sizeof(std::int32_t)>;
  const std::vector<ShadingMath> device_results = on_device(device());
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto expected = std::bit_cast<Words>(evaluate_shading_math(i).decisions);
    ASSERT_EQ(std::bit_cast<Words>(device_results[i].decisions), expected) << i;
  }
}

}  // namespace
}  // namespace lambent::shading_math_test
