// SPDX-License-Identifier: Apache-2.0
// Which devices there are, and pictures on them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program.h"

namespace lambent::backend_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;

// No more than a few seconds on a processor that plays a device.
const std::string kSmall = " --size 32x24 --samples 1 --updates 1 --probes 3x3x3 --rays 32";
// Where a ray grazes an edge, or a random decision is as close as rounding, single pixels differ.
constexpr double kMaxRelativeRmse = 0.01;

/// Keeps Vulkan from finding any driver while it lives.
class NoDriver {
 public:
  NoDriver() {
    setenv("VK_ICD_FILENAMES", "/nowhere", 1);
    setenv("VK_DRIVER_FILES", "/nowhere", 1);
  }
  ~NoDriver() {
    unsetenv("VK_ICD_FILENAMES");
    unsetenv("VK_DRIVER_FILES");
  }
};

/// Whether a driver was installed for the tests, so that a missing device is a failure.
bool device_is_required() {
  return std::getenv("LAMBENT_REQUIRE_DEVICE") != nullptr;
}

/// A test that renders on a device. It is skipped only where the program lists no device that can
/// be used: whatever goes wrong on one that can is a failure.
class VulkanBackend : public ::testing::Test {
 protected:
  void SetUp() override {
    const ProgramResult listed = run_program("devices --json");
    if (listed.status == 0) {
      const auto usable = nlohmann::json::parse(listed.output).at("usable");
      if (std::find(usable.begin(), usable.end(), true) != usable.end()) return;
    }
    const std::string why = "no Vulkan device can be used: " + listed.output + listed.errors;
    if (device_is_required()) FAIL() << why;
    GTEST_SKIP() << why;
  }
};

TEST(Devices, AreListedForPeopleAndForPrograms) {
  const ProgramResult json = run_program("devices --json");
  const ProgramResult table = run_program("devices");
  EXPECT_EQ(table.status, json.status);
  if (json.status != 0) {
    EXPECT_EQ(json.status, 1);
    EXPECT_THAT(json.errors, HasSubstr("Vulkan"));
    EXPECT_FALSE(device_is_required()) << json.errors;
    GTEST_SKIP() << json.errors;
  }
  const auto devices = nlohmann::json::parse(json.output);
  const auto count = devices.at("devices").get<std::size_t>();
  for (const char* list : {"names", "drivers", "api_versions", "software", "usable", "missing"}) {
    EXPECT_EQ(devices.at(list).size(), count) << list;
  }
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_THAT(table.output, HasSubstr(devices["names"][i].get<std::string>()));
    EXPECT_EQ(devices["usable"][i].get<bool>(), devices["missing"][i].empty());
  }
}

TEST(Devices, AreMissedWithACauseAndLeaveNoFile) {
  const NoDriver none;
  const test::TemporaryDirectory directory;
  for (const std::string& arguments :
       {std::string("devices"), "render cornell --backend vulkan -o " + directory.file("a.exr")}) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_THAT(result.errors, HasSubstr("Vulkan"));
  }
  EXPECT_EQ(directory.entries(), 0u);
}

TEST_F(VulkanBackend, PaintsWhatTheProcessorPaints) {
  const test::TemporaryDirectory directory;
  const std::string ours = directory.file("vulkan.exr"), theirs = directory.file("cpu.exr");
  const std::string stats = directory.file("stats.json");
  const ProgramResult painted = run_program("render cornell --backend vulkan --vulkan-validation" +
                                            kSmall + " -o " + ours + " --stats " + stats);
  ASSERT_EQ(painted.status, 0) << painted.errors;
  ASSERT_EQ(run_program("render cornell" + kSmall + " -o " + theirs).status, 0);
  const ProgramResult compared = run_program("compare " + ours + " " + theirs + " --json");
  ASSERT_EQ(compared.status, 0) << compared.errors;
  EXPECT_LT(nlohmann::json::parse(compared.output).at("relative_rmse").get<double>(),
            kMaxRelativeRmse);
  const auto told = nlohmann::json::parse(std::ifstream(stats));
  EXPECT_EQ(told.at("backend"), "vulkan");
  EXPECT_FALSE(told.at("device").get<std::string>().empty());
}

}  // namespace
}  // namespace lambent::backend_test
