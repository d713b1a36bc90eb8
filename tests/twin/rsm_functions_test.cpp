// SPDX-License-Identifier: Apache-2.0
// The functions of the interleaved gather in C++ and in GLSL.
#include "twin/rsm_functions.h"

#include <cmath>

#include "shaders/rsm_functions_comp.h"
#include "support/vulkan_device.h"
#include "vulkan/recorder.h"

namespace lambent::rsm_functions_test {
namespace {

using RsmFunctionsTwin = test::OnDevice;

constexpr std::uint32_t kCalls = 600;
// Devices may round sines, quotients and square roots by some units in the last place more, and
// fuse products with sums; what cancels keeps that as an absolute error.
constexpr float kRelative = 2e-5f, kAbsolute = 2e-6f;

TEST_F(RsmFunctionsTwin, GiveTheSameOnTheDevice) {
  const vulkan::Buffer buffer(device(), kCalls * sizeof(RsmFunctionResults), vulkan::Memory::device,
                              "results");
  const vulkan::Kernel kernel(device(), shaders::rsm_functions_comp(), "rsm_functions");
  const RsmFunctionsArguments arguments = {{buffer.address()}, kCalls, 0};
  device().run([&](vulkan::Recorder& to) { to.run(kernel, arguments, kCalls); });
  const auto results = vulkan::download<RsmFunctionResults>(device(), buffer);
  for (std::uint32_t i = 0; i < kCalls; ++i) {
    const RsmFunctionResults expected = call_rsm_functions(i);
    for (int k = 0; k < kRsmFloats; ++k) {
      const float value = expected.floats[k];
      EXPECT_NEAR(results[i].floats[k], value, kAbsolute + kRelative * std::abs(value))
          << "result " << k << " of call " << i;
    }
    for (int k = 0; k < kRsmInts; ++k) EXPECT_EQ(results[i].ints[k], expected.ints[k]) << k;
  }
}

}  // namespace
}  // namespace lambent::rsm_functions_test
