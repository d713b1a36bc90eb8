// SPDX-License-Identifier: Apache-2.0
// Which devices there are, and pictures on them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "support/program.h"

namespace lambent {
namespace {

using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;

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

TEST(Devices, AreListedForPeopleAndForPrograms) {
  const ProgramResult json = run_program("devices --json");
  const ProgramResult table = run_program("devices");
  EXPECT_EQ(table.status, json.status);
  if (json.status != 0) {
    EXPECT_EQ(json.status, 1);
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
  const testing::TemporaryDirectory directory;
  for (const std::string& arguments :
       {std::string("devices"), "render cornell --backend vulkan -o " + directory.file("a.exr")}) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_THAT(result.errors, HasSubstr("Vulkan"));
  }
  EXPECT_EQ(directory.entries(), 0u);
}

TEST(VulkanBackend, PaintsWhatTheProcessorPaints) {
  const testing::TemporaryDirectory directory;
  const std::string ours = directory.file("vulkan.exr"), theirs = directory.file("cpu.exr");
  const std::string stats = directory.file("stats.json");
  const ProgramResult painted = run_program("render cornell --backend vulkan --vulkan-validation" +
                                            kSmall + " -o " + ours + " --stats " + stats);
  if (painted.status == 1) GTEST_SKIP() << painted.errors;
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
}  // namespace lambent
