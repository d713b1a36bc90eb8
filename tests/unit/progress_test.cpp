// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "lambent/progress_bar.h"

namespace lambent::cli::progress_test {
namespace {

/// A bar on a terminal of 60 columns whose clock the test moves.
struct Bench {
  double now = 100.0;
  std::string output;
  ProgressBar bar{[this](std::string_view text) { output += text; }, [this] { return now; }, 60};
};

TEST(ProgressLine, ShowsShareAndTimeLeft) {
  EXPECT_EQ(progress_line("trace", 0.25, 10.0, 40), "trace  [###...........]  25 %  30 s left");
  EXPECT_NE(progress_line("trace", 0.5, 185.0, 80).find("3 min 05 s left"), std::string::npos);
  EXPECT_NE(progress_line("trace", 0.5, 7800.0, 80).find("2 h 10 min left"), std::string::npos);
}

TEST(ProgressLine, FitsItsColumnsAndTakesAnyShare) {
  for (int columns = 0; columns < 90; ++columns) {
    for (const double share : {-1.0, 0.0, 0.001, 0.5, 2.0, 0.0 / 0.0}) {
      EXPECT_LE(progress_line("a rather long stage", share, 5.0, columns).size(),
                static_cast<std::size_t>(columns));
    }
  }
}

TEST(ProgressBar, IsSilentForStagesUnderASecond) {
  Bench bench;
  for (int i = 0; i <= 10; ++i) {
    bench.bar.update("quick", i / 10.0);
    bench.now += 0.09;
  }
  EXPECT_EQ(bench.output, "");
}

TEST(ProgressBar, DrawsAtMostTenTimesASecondAndWipesWhenDone) {
  Bench bench;
  for (int i = 0; i < 300; ++i) {
    bench.bar.update("slow", i / 300.0);
    bench.now += 0.01;
  }
  std::size_t drawings = 0;
  for (std::size_t at = bench.output.find('['); at != std::string::npos;
       at = bench.output.find("  [", at + 1)) {
    ++drawings;
  }
  EXPECT_GE(drawings, 10u);
  EXPECT_LE(drawings, 21u);
  bench.bar.update("slow", 1.0);
  EXPECT_TRUE(bench.output.ends_with("\r\x1b[K"));
}

TEST(ProgressBar, MeasuresEachStageFromItsOwnStart) {
  Bench bench;
  bench.bar.update("first", 0.0);
  bench.now += 1000.0;
  bench.bar.update("second", 0.0);
  bench.now += 4.0;
  bench.bar.update("second", 0.5);
  EXPECT_NE(bench.output.find("4 s left"), std::string::npos) << bench.output;
}

TEST(ProgressLog, WritesALineInHalfAMinuteAndNoneOfWhatIsDone) {
  std::string output;
  double now = 7.0;
  ProgressLog log([&](std::string_view line) { output += std::string(line) + "\n"; },
                  [&] { return now; });
  log.update("first", 0.5);
  now += 31.0;
  log.update("first", 1.0);
  EXPECT_EQ(output, "");
  log.update("second", 0.0);
  EXPECT_EQ(output, "second: 0 %\n");
  now += 20.0;
  log.update("second", 0.25);
  now += 10.0;
  log.update("second", 0.75);
  EXPECT_EQ(output, "second: 0 %\nsecond: 75 %, 10 s left\n");
}

TEST(ProgressBar, WipesItsLineWhenAbandoned) {
  std::string output;
  double now = 0.0;
  {
    ProgressBar bar([&](std::string_view text) { output += text; }, [&] { return now; }, 60);
    bar.update("slow", 0.1);
    now = 2.0;
    bar.update("slow", 0.2);
    EXPECT_FALSE(output.empty());
  }
  EXPECT_TRUE(output.ends_with("\r\x1b[K"));
}

}  // namespace
}  // namespace lambent::cli::progress_test
