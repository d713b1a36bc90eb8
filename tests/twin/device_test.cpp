// SPDX-License-Identifier: Apache-2.0
// Devices, buffers, kernels and recording by themselves.
#include <cstddef>
#include <numeric>

#include "shaders/echo_comp.h"
#include "support/vulkan_device.h"
#include "twin/echo.h"
#include "vulkan/buffer.h"
#include "vulkan/recorder.h"
#include "vulkan/reflect.h"

namespace lambent::device_test {
namespace {

using VulkanDevice = test::OnDevice;

TEST_F(VulkanDevice, TellsWhatItIs) {
  EXPECT_FALSE(description(device()).name.empty());
  EXPECT_TRUE(description(device()).missing.empty());
}

TEST_F(VulkanDevice, GivesBackWhatItWasGiven) {
  std::vector<float> numbers(1000);
  std::iota(numbers.begin(), numbers.end(), 0.5f);
  const vulkan::Buffer buffer = vulkan::upload(device(), numbers, "numbers");
  EXPECT_EQ(vulkan::download<float>(device(), buffer), numbers);
  const std::vector<float> few = {7.0f, 8.0f};
  vulkan::write(device(), std::span<const float>(few), buffer, 500);
  std::vector<float> back(4);
  vulkan::read(device(), buffer, std::span<float>(back), 499);
  EXPECT_EQ(back, (std::vector<float>{499.5f, 7.0f, 8.0f, 502.5f}));
}

TEST_F(VulkanDevice, HasAnAddressForABufferOfNothing) {
  const vulkan::Buffer buffer(device(), 0, vulkan::Memory::device, "nothing");
  EXPECT_TRUE(buffer.empty());
  EXPECT_NE(buffer.address(), 0u);
}

TEST_F(VulkanDevice, AlignsAddresses) {
  for (const std::size_t alignment : {16, 256, 4096}) {
    const vulkan::Buffer buffer(device(), 100, vulkan::Memory::device, "aligned", alignment);
    EXPECT_EQ(buffer.address() % alignment, 0u);
  }
}

// Every member of a struct that both languages read arrives where it was put.
TEST_F(VulkanDevice, ReadsStructsAsTheHostWroteThem) {
  const EchoRecord record = {
      1.0f, vec3(2.0f, 3.0f, 4.0f), 5u, vec2(6.0f, 7.0f), 8, mat3(9.0f), vec4(10.0f)};
  const vulkan::Buffer in = vulkan::upload(device(), std::span(&record, 1), "record");
  const vulkan::Buffer out(device(), 20 * sizeof(float), vulkan::Memory::device, "members");
  const vulkan::Kernel kernel(device(), shaders::echo_comp(), "echo");
  const EchoArguments arguments = {{in.address()}, {out.address()}, 1u, 2.0f};
  device().run([&](vulkan::Recorder& to) { to.run(kernel, arguments, 1); });
  const std::vector<float> members = vulkan::download<float>(device(), out);
  const std::vector<float> expected = {2, 4, 6,  8, 10, 12, 14, 16, 18, 0,
                                       0, 0, 18, 0, 0,  0,  18, 20, 20, 20};
  EXPECT_EQ(members, expected);
}

TEST_F(VulkanDevice, TakesTheTimeOfPasses) {
  const vulkan::Buffer buffer(device(), 1 << 16, vulkan::Memory::device, "filled");
  vulkan::Timestamps timestamps(device(), 4);
  device().run([&](vulkan::Recorder& untimed) {
    vulkan::Recorder to(device(), untimed.commands(), &timestamps);
    for (const char* name : {"one", "two", "one"}) {
      to.begin_pass(name);
      to.fill(buffer, 1u);
      to.end_pass();
      to.barrier();
    }
  });
  const std::vector<vulkan::DevicePassTime> times = timestamps.read();
  if (device().limits().timestamp_period_ns == 0.0f) GTEST_SKIP() << "no timestamps";
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].name, "one");
  EXPECT_EQ(times[1].name, "two");
  EXPECT_GE(times[0].ms, 0.0);
}

TEST(VulkanReflection, FindsArgumentsWhereTheHostPutsThem) {
  const vulkan::Reflection shader = vulkan::reflect(shaders::echo_comp());
  EXPECT_EQ(shader.argument_bytes, sizeof(EchoArguments));
  EXPECT_EQ(shader.argument_offsets,
            (std::vector<std::uint32_t>{
                offsetof(EchoArguments, records), offsetof(EchoArguments, members),
                offsetof(EchoArguments, count), offsetof(EchoArguments, scale)}));
  EXPECT_EQ(shader.group_size[0], 64u);
  EXPECT_TRUE(shader.bindings.empty());
}

TEST(VulkanReflection, RefusesWhatIsNotSpirv) {
  const std::vector<std::uint32_t> words = {1, 2, 3, 4, 5, 6};
  EXPECT_THROW(vulkan::reflect(words), std::runtime_error);
}

TEST(VulkanDevices, SaysWhichThereAre) {
  const auto found = vulkan::devices();
  const auto beyond = vulkan::open_device({.index = 1000});
  EXPECT_FALSE(beyond);
  if (!found) GTEST_SKIP() << found.error().message();
  for (const vulkan::DeviceDescription& device : *found) EXPECT_FALSE(device.name.empty());
}

}  // namespace
}  // namespace lambent::device_test
