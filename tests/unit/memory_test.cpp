// SPDX-License-Identifier: Apache-2.0
#include "core/memory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "support/temporary_directory.h"

namespace lambent::memory_test {
namespace {

namespace fs = std::filesystem;

/// A tree of files in place of /proc and /sys.
class AvailableMemory : public ::testing::Test {
 protected:
  void write(const std::string& path, const std::string& text) {
    const fs::path file = directory.path() / path;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  std::uint64_t available() const { return available_memory(directory.path().string()); }

  test::TemporaryDirectory directory;
};

TEST_F(AvailableMemory, IsWhatTheSystemCallsSo) {
  write("proc/meminfo", "MemTotal:       16000 kB\nMemFree: 10 kB\nMemAvailable:    8000 kB\n");
  EXPECT_EQ(available(), 8000u * 1024u);
}

TEST_F(AvailableMemory, IsBoundedByEachControlGroupAbove) {
  write("proc/meminfo", "MemAvailable:    8000 kB\n");
  write("proc/self/cgroup", "0::/outer/inner\n");
  write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  write("sys/fs/cgroup/outer/inner/memory.current", "1000\n");
  EXPECT_EQ(available(), 8000u * 1024u);
  write("sys/fs/cgroup/outer/memory.max", "5000\n");
  write("sys/fs/cgroup/outer/memory.current", "3000\n");
  EXPECT_EQ(available(), 2000u);
  // Files that are kept in memory can be dropped
  write("sys/fs/cgroup/outer/memory.stat", "anon 1500\ninactive_file 500\n");
  EXPECT_EQ(available(), 2500u);
}

TEST_F(AvailableMemory, IsBoundedByControlGroupsOfTheFirstVersion) {
  write("proc/self/cgroup", "12:cpu,cpuacct:/job\n9:memory:/job\n");
  write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "7000\n");
  write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "9000\n");
  EXPECT_EQ(available(), 0u);
}

TEST_F(AvailableMemory, IsAllThereCouldBeWhereNothingIsKnown) {
  EXPECT_EQ(available(), std::numeric_limits<std::uint64_t>::max());
}

TEST(BytesText, HasTwoOrThreeDigitsAndAUnit) {
  EXPECT_EQ(bytes_text(0), "0 bytes");
  EXPECT_EQ(bytes_text(999), "999 bytes");
  EXPECT_EQ(bytes_text(1500), "1.5 kB");
  EXPECT_EQ(bytes_text(23'400'000'000), "23 GB");
  EXPECT_EQ(bytes_text(999'900'000), "1.0 GB");
}

}  // namespace
}  // namespace lambent::memory_test
