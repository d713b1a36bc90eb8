// SPDX-License-Identifier: Apache-2.0
// What takes much memory is done some rows at a time, or refused before it starts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::large_work_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;

// Sanitizers take address space and memory of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kOwnMemory = false;
#else
constexpr bool kOwnMemory = true;
#endif

// Address space in which the program starts, with room for 1.4 GB [KiB].
const std::string kLittleMemory = "ulimit -v 1500000;";

class LargeWork : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!kOwnMemory) GTEST_SKIP() << "limits of memory mean nothing to sanitizers";
  }
  std::string file(const std::string& name) const { return directory.file(name); }
  std::string content(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  test::TemporaryDirectory directory;
};

/// Runs the program and returns the most memory that it had [bytes]; 0 where it failed.
std::uint64_t peak_of(const std::vector<std::string>& arguments) {
  const pid_t child = test::start_program(arguments);
  int status = -1;
  rusage use{};
  wait4(child, &status, 0, &use);
  constexpr std::uint64_t kKibibyte = 1024;
  return status == 0 ? static_cast<std::uint64_t>(use.ru_maxrss) * kKibibyte : 0;
}

TEST_F(LargeWork, PicturesWithAllLayersTakeTheMemoryOfSomeRows) {
  // 2.1 million pixels more of all layers are 235 MB
  constexpr std::uint64_t kAllLayers = std::uint64_t{1100} * 1900 * 28 * sizeof(float);
  const std::vector<std::string> render = {"render",    "cornell", "--method",  "direct",
                                           "--quality", "draft",   "--samples", "1",
                                           "--layers",  "-o"};
  const auto peak = [&](const char* size) {
    std::vector<std::string> arguments = render;
    arguments.insert(arguments.end(), {file("a.exr"), "--size", size});
    return peak_of(arguments);
  };
  const std::uint64_t small = peak("1100x950"), large = peak("1100x2850");
  ASSERT_GT(small, 0u);
  ASSERT_GT(large, 0u);
  EXPECT_LT(large, small + kAllLayers / 3);
}

TEST_F(LargeWork, APictureOfManyBandsIsThatOfItsLayers) {
  // 1.2 million pixels are two bands, and where they are filtered 2.2 million
  for (const std::string quality : {"draft --size 1100x1100", "high --size 1100x2000"}) {
    const std::string render =
        "render cornell --method direct --samples 1 --quality " + quality + " -o ";
    // With its layers the file knows albedo, which the exposure follows
    ASSERT_EQ(run_program(render + file("a.exr") + " --layers").status, 0);
    ASSERT_EQ(run_program(render + file("a.png")).status, 0);
    ASSERT_EQ(run_program("picture " + file("a.exr") + " -o " + file("b.png")).status, 0);
    EXPECT_TRUE(content("a.png") == content("b.png")) << quality;
  }
  // With an exposure, rows are shown before those below them are there. Both bands end at
  // edges of what is white
  const std::string bright = " --exposure 6 -o ";
  const std::string render =
      "render cornell --method direct --samples 1 --quality draft --size 1100x1100";
  ASSERT_EQ(run_program(render + bright + file("c.png")).status, 0);
  ASSERT_EQ(run_program(render + " -o " + file("c.exr")).status, 0);
  ASSERT_EQ(run_program("picture " + file("c.exr") + bright + file("d.png")).status, 0);
  EXPECT_TRUE(content("c.png") == content("d.png"));
}

TEST_F(LargeWork, PicturesThatDoNotFitAreRefusedWithASizeThatDoes) {
  for (const std::string method : {"rsm", "reference"}) {
    const std::string render =
        "render cornell --method " + method + " -o " + file("a.png") + " --size ";
    const auto start = std::chrono::steady_clock::now();
    const ProgramResult result = run_program(render + "16384x8192", kLittleMemory);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.errors, HasSubstr("16384x8192 with --method " + method + " needs about "));
    std::smatch fits;
    const std::regex pattern("; ([0-9]+)x([0-9]+) would fit");
    ASSERT_TRUE(std::regex_search(result.errors, fits, pattern)) << result.errors;
    EXPECT_NEAR(std::stod(fits[1]) / std::stod(fits[2]), 2.0, 0.01);
    EXPECT_GT(std::stoi(fits[1]), 1000);
    EXPECT_EQ(directory.entries(), 0u);
  }
}

TEST_F(LargeWork, FieldsThatDoNotFitAreRefusedWithWhatDoes) {
  const std::string field = " cornell --probes 61x61x61 -o ";
  for (const std::string& command : {"render --size 8x8 --samples 1" + field + file("a.png"),
                                     "bake" + field + file("a.field")}) {
    const ProgramResult result = run_program(command + " --rays 4096", kLittleMemory);
    EXPECT_EQ(result.status, 1) << command;
    EXPECT_THAT(result.errors, HasSubstr("226981 probes of 4096 rays: needs about 1"));
    EXPECT_THAT(result.errors, HasSubstr(" probes would fit"));
    EXPECT_EQ(directory.entries(), 0u);
  }
  const ProgramResult rays = run_program(
      "bake cornell --probes 21x21x21 --rays 4096 -o " + file("a.field"), kLittleMemory);
  EXPECT_EQ(rays.status, 1);
  EXPECT_THAT(rays.errors, ::testing::ContainsRegex("--rays [0-9]+, or [0-9]+ probes would fit"));
}

TEST_F(LargeWork, WhatIsSaidToFitDoes) {
  const std::string bake =
      "bake cornell --probes 12x12x12 --updates 1 --threads 1 -o " + file("a.field");
  // One heap for all threads, as each further one takes 64 MB of addresses when it happens to start
  const std::string limit = "ulimit -v 700000; export MALLOC_ARENA_MAX=1;";  // [KiB]
  const ProgramResult refused = run_program(bake + " --rays 4096", limit);
  std::smatch fits;
  ASSERT_TRUE(std::regex_search(refused.errors, fits, std::regex("--rays ([0-9]+)")));
  const ProgramResult made = run_program(bake + " --rays " + fits[1].str(), limit);
  EXPECT_EQ(made.status, 0) << made.errors;
}

}  // namespace
}  // namespace lambent::large_work_test
