// SPDX-License-Identifier: Apache-2.0
// --quality, and the options that say otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::quality_test {
namespace {

using test::run_program;
using ::testing::HasSubstr;

const std::string kQuick = "cornell --size 24x16 --probes 3x3x3 --rays 32 --updates 1 ";

class QualityOption : public ::testing::Test {
 protected:
  /// Statistics of a picture.
  nlohmann::json stats_of(const std::string& options) const {
    const std::string stats = directory.file("stats.json");
    const test::ProgramResult result = run_program("render " + kQuick + options + " -o " +
                                                   directory.file("a.exr") + " --stats " + stats);
    EXPECT_EQ(result.status, 0) << options << ": " << result.errors;
    std::ifstream stream(stats);
    return nlohmann::json::parse(stream);
  }
  /// Which of the passes that a quality decides on run.
  std::string passes_of(const std::string& options) const {
    const nlohmann::json stats = stats_of(options);
    std::string passes;
    for (const std::string pass : {"guide", "indirect", "gather", "denoise"}) {
      if (stats.contains(pass + "_ms")) passes += pass + " ";
    }
    return passes;
  }

  test::TemporaryDirectory directory;
};

TEST_F(QualityOption, ChoosesThePasses) {
  EXPECT_EQ(passes_of(""), "guide indirect gather denoise ");
  EXPECT_EQ(passes_of("--quality high"), "guide indirect gather denoise ");
  EXPECT_EQ(passes_of("--quality interactive"), "indirect gather denoise ");
  EXPECT_EQ(passes_of("--quality draft"), "indirect ");
}

TEST_F(QualityOption, IsOverruledByOptionsOfItsParts) {
  EXPECT_EQ(passes_of("--without gather"), "indirect denoise ");
  EXPECT_EQ(passes_of("--without guide"), "indirect gather denoise ");
  EXPECT_EQ(passes_of("--without denoise"), "guide gather ");
  EXPECT_EQ(passes_of("--without gather,denoise"), "indirect ");
  EXPECT_EQ(passes_of("--gather 0"), "indirect denoise ");
  EXPECT_EQ(passes_of("--quality draft --gather 2"), "guide gather ");
  // A gathering ray would be a bounce more than the field's
  EXPECT_EQ(passes_of("--bounces 1"), "indirect denoise ");
  EXPECT_GT(stats_of("--quality interactive --samples 3")["camera_rays"].get<int>(),
            2 * stats_of("--quality interactive")["camera_rays"].get<int>());
}

TEST_F(QualityOption, GathersMoreTheHigherItIs) {
  const int interactive = stats_of("--quality interactive")["camera_rays"];
  EXPECT_GT(stats_of("--quality high")["camera_rays"].get<int>(), 10 * interactive);
}

TEST_F(QualityOption, SeesProbesByRaysWhereItIsHigh) {
  const auto visibility_ms = [&](const std::string& options) {
    return stats_of(options)["visibility_ms"].get<double>();
  };
  EXPECT_GT(visibility_ms(""), 0.0);
  EXPECT_EQ(visibility_ms("--quality draft"), 0.0);
  EXPECT_EQ(visibility_ms("--visibility moments"), 0.0);
}

TEST_F(QualityOption, AveragesLightOverFramesOfASequence) {
  const auto frames_of = [&](const std::string& options) {
    return stats_of(options + " --frames 2").at("frames");
  };
  for (const char* averaged : {"", "--quality interactive"}) {
    for (const auto& frame : frames_of(averaged)) EXPECT_TRUE(frame.contains("history_ms"));
  }
  for (const char* alone : {"--quality draft", "--quality high"}) {
    for (const auto& frame : frames_of(alone)) EXPECT_FALSE(frame.contains("history_ms"));
  }
}

TEST_F(QualityOption, RefusesWhatDoesNotGoTogether) {
  const std::pair<const char*, const char*> cases[] = {
      {"--without denoice", "--without"},
      {"--quality best", "--quality"},
      {"--gather 4 --without gather", "--gather"},
      {"--coat-rays 2 --without glossy", "--coat-rays"},
      {"--most-samples 0", "--most-samples"},
      {"--samples 8 --most-samples 12", "--most-samples"},
      {"--quality interactive --most-samples 4", "--most-samples"},
      {"--frames 2 --most-samples 4", "--most-samples"}};
  for (const auto& [options, named] : cases) {
    const test::ProgramResult result =
        run_program("render " + kQuick + options + " -o " + directory.file("a.exr"));
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_THAT(result.errors, HasSubstr(named)) << options;
  }
}

}  // namespace
}  // namespace lambent::quality_test
