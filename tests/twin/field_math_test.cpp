// SPDX-License-Identifier: Apache-2.0
#include "twin/field_math.h"

#include <vector>

#include "shaders/field_math_comp.h"
#include "support/vulkan_device.h"
#include "vulkan/recorder.h"

namespace lambent::field_math_test {
namespace {

using FieldMath = test::OnDevice;

TEST_F(FieldMath, AgreesWithTheProcessor) {
  constexpr std::uint32_t kCases = 4096;
  std::vector<float> in(kCases * kFieldMathInputs);
  RandomStream random = make_random_stream(1, 2, 3);
  for (float& number : in) number = next_uniform(random);
  const vulkan::Buffer numbers = vulkan::upload(device(), in, "numbers");
  const vulkan::Buffer results(device(), sizeof(float) * kCases * kFieldMathOutputs,
                               vulkan::Memory::device, "results");
  const vulkan::Kernel kernel(device(), shaders::field_math_comp(), "field math");
  const FieldMathArguments arguments = {{numbers.address()}, {results.address()}, kCases, 0u};
  device().run([&](vulkan::Recorder& to) { to.run(kernel, arguments, kCases); });
  const std::vector<float> found = vulkan::download<float>(device(), results);
  for (std::uint32_t i = 0; i < kCases; ++i) {
    const float* n = &in[i * kFieldMathInputs];
    const auto four = [&](int k) { return vec4(n[k], n[k + 1], n[k + 2], n[k + 3]); };
    const FieldMathResult expected = field_math(four(0), four(4), four(8), four(12));
    for (int k = 0; k < kFieldMathOutputs; ++k) {
      const float is = found[i * kFieldMathOutputs + k], should = expected.number[k];
      if (k < kFieldMathExact) {
        ASSERT_EQ(is, should) << i << " " << k;
      } else {
        // Divisions, roots and powers of a device are off by a few units in the last place, and the
        // 100th power multiplies this error
        ASSERT_NEAR(is, should, 1e-4f * abs(should) + 1e-6f) << i << " " << k;
      }
    }
  }
}

TEST(Wide, KeepsTwiceTheDigits) {
  Wide sum = make_wide(0.0f);
  double exact = 0.0;
  RandomStream random = make_random_stream(4, 5, 6);
  for (int i = 0; i < 100000; ++i) {
    const float x = next_uniform(random), y = next_uniform(random) - 0.5f;
    sum = wide_add(sum, wide_divide(exact_product(x, y), make_wide(1.0f + x)));
    exact += static_cast<double>(x) * y / (1.0f + x);
  }
  EXPECT_NEAR(static_cast<double>(sum.high) + sum.low, exact, 1e-9);
}

TEST(AndersonMath, TakesStepsBackSoThatNothingIsLeft) {
  // The residual is a weighted sum of the steps' changes: the weights are the coefficients
  const vec3 a(1.0f, 0.2f, 0.1f), b(0.3f, -1.0f, 0.4f), c(0.2f, 0.5f, 0.9f);
  const vec3 coefficients =
      step_coefficients(some_products(a, b, c, 0.5f * a - 2.0f * b + 0.25f * c), 3);
  EXPECT_NEAR(coefficients.x, 0.5f, 1e-5f);
  EXPECT_NEAR(coefficients.y, -2.0f, 1e-5f);
  EXPECT_NEAR(coefficients.z, 0.25f, 1e-5f);
}

}  // namespace
}  // namespace lambent::field_math_test
