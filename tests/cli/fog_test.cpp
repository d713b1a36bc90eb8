// SPDX-License-Identifier: Apache-2.0
// --fog, and what else says how fog is seen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::fog_test {
namespace {

using test::run_program;
using ::testing::HasSubstr;

const std::string kPicture = "render cornell --size 24x16 ";
const std::string kQuick = kPicture + "--probes 3x3x3 --rays 32 --updates 1 ";

class FogOption : public ::testing::Test {
 protected:
  /// Mean of a layer of a picture.
  double mean_of(const std::string& options, const char* layer,
                 const std::string& command = kQuick) const {
    const std::string path = directory.file("a.exr");
    const test::ProgramResult result = run_program(command + options + " --layers -o " + path);
    EXPECT_EQ(result.status, 0) << result.errors;
    const Expected<LayeredImage> image = read_image(path);
    const Image& values = *image->find(layer);
    double sum = 0.0;
    for (const float value : values.pixels) sum += value;
    return sum / static_cast<double>(values.pixels.size());
  }

  test::TemporaryDirectory directory;
};

TEST_F(FogOption, FillsTheScene) {
  EXPECT_EQ(mean_of("--quality draft", "fog"), 0.0);
  const double thin = mean_of("--quality draft --fog 0.05", "fog");
  const double dense = mean_of("--quality draft --fog 0.2", "fog");
  EXPECT_GT(thin, 0.0);
  EXPECT_GT(dense, 2.0 * thin);
  EXPECT_LT(mean_of("--quality draft --fog 0.2", "direct"),
            0.9 * mean_of("--quality draft", "direct"));
  EXPECT_EQ(mean_of("--quality draft --fog 0.2,0", "fog"), 0.0);
  // Fog that thins with height is less fog
  EXPECT_LT(mean_of("--quality draft --fog 0.2,0.9,0,0.1", "fog"), 0.5 * dense);
  EXPECT_GT(mean_of("--method reference --samples 4 --fog 0.2", "fog", kPicture), 0.0);
}

TEST_F(FogOption, FollowsTheSizeOfFroxels) {
  EXPECT_NE(mean_of("--fog 0.2 --froxel 2", "fog"), mean_of("--fog 0.2 --froxel 9", "fog"));
}

TEST_F(FogOption, IsInTheStatistics) {
  const std::string stats = directory.file("stats.json");
  for (const bool fog : {false, true}) {
    const test::ProgramResult result = run_program(kQuick + (fog ? "--fog 0.1 " : "") + "-o " +
                                                   directory.file("a.exr") + " --stats " + stats);
    ASSERT_EQ(result.status, 0) << result.errors;
    std::ifstream stream(stats);
    EXPECT_EQ(nlohmann::json::parse(stream).contains("fog_ms"), fog);
  }
}

TEST_F(FogOption, RefusesWhatMakesNoSense) {
  const std::pair<const char*, const char*> cases[] = {
      {"--fog x", "'x' is not a density"},
      {"--fog 0.1,0.9,0,1,2", "is not a density"},
      {"--fog 0.1,,0", "is not a density"},
      {"--fog nan", "is not a density"},
      {"--fog=-0.1", "density that is not within"},
      {"--fog 1e7", "density that is not within"},
      {"--fog 0.1,1.5", "albedo that is not within"},
      {"--fog 0.1,0.9,0.96", "anisotropy that is not within"},
      {"--fog 0.1,0.9,0,1e-4", "scale height that is neither"},
      {"--fog 0.1,0.9,0,-1", "scale height that is neither"},
      {"--fog 0.1 --without fog", "does not go with --without fog"},
      {"--froxel 0", "--froxel"},
      {"--froxel 65", "--froxel"},
      {"--froxel 4 --without fog", "does not go with --without fog"}};
  for (const auto& [options, complaint] : cases) {
    const test::ProgramResult result =
        run_program(kQuick + options + " -o " + directory.file("b.exr"));
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_THAT(result.errors, HasSubstr(complaint)) << options;
  }
}

}  // namespace
}  // namespace lambent::fog_test
