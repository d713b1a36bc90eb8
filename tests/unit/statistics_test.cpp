// SPDX-License-Identifier: Apache-2.0
#include "core/statistics.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/file_bytes.h"
#include "support/temporary_directory.h"

namespace lambent {
namespace {

TEST(Statistics, KeepsTheOrderOfFirstMentionAndAddsUp) {
  Statistics statistics;
  statistics.set("rays", 4096.0);
  statistics.add(PassTime{"trace", 1.25});
  statistics.add(PassTime{"trace", 1.25});
  statistics.set("rays", 8192.0);
  statistics.set("ratio", std::numeric_limits<double>::infinity());
  EXPECT_EQ(statistics.json(), "{\n  \"rays\": 8192,\n  \"trace_ms\": 2.5,\n  \"ratio\": null\n}\n");
  EXPECT_EQ(*statistics.find("trace_ms"), 2.5);
  EXPECT_EQ(statistics.find("shade_ms"), nullptr);
}

TEST(Statistics, WritesAllOrNothing) {
  const testing::TemporaryDirectory directory;
  Statistics statistics;
  statistics.set("rays", 1.0);
  ASSERT_TRUE(statistics.write(directory.file("a.json")));
  EXPECT_EQ(read_file(directory.file("a.json"))->size(), statistics.json().size());
  EXPECT_FALSE(statistics.write(directory.file("missing/a.json")));
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(Stopwatch, RunsForwardAndRestarts) {
  const Stopwatch since_start;
  Stopwatch watch;
  while (watch.ms() < 2.0) {
  }
  watch.restart();
  const double after_restart = watch.ms();
  EXPECT_GE(since_start.ms(), after_restart + 2.0);
}

}  // namespace
}  // namespace lambent
