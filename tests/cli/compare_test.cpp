// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::compare_test {
namespace {

using test::run_program;

LayeredImage frame(float direct, float indirect) {
  LayeredImage image{16, 8, {}};
  for (const auto& [name, value] :
       {std::pair{"", direct + indirect}, {"direct", direct}, {"indirect", indirect}}) {
    for (float& pixel : image.require(name, 3).pixels) pixel = value;
  }
  return image;
}

class Compare : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_exr(a, frame(0.5f, 0.3f)));
    ASSERT_TRUE(write_exr(b, frame(0.5f, 0.2f)));
  }
  test::TemporaryDirectory directory;
  std::string a = directory.file("a.exr"), b = directory.file("b.exr");
};

TEST_F(Compare, PrintsARowForEachCommonLayer) {
  const auto result = run_program("compare " + a + " " + b);
  EXPECT_EQ(result.status, 0) << result.errors;
  for (const char* word : {"(picture)", "direct", "indirect", "SSIM", "HDR-FLIP"}) {
    EXPECT_NE(result.output.find(word), std::string::npos) << word;
  }
}

TEST_F(Compare, JsonIsFlatWithLayersAsPrefixes) {
  const auto result = run_program("compare --json " + a + " " + b);
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_NEAR(json.at("mean_ratio").get<double>(), 0.8 / 0.7, 1e-5);
  EXPECT_NEAR(json.at("indirect.mean_ratio").get<double>(), 1.5, 1e-5);
  EXPECT_NEAR(json.at("indirect.relative_rmse").get<double>(), 0.5, 1e-5);
  EXPECT_EQ(json.at("direct.rmse").get<double>(), 0.0);
  EXPECT_TRUE(json.at("direct.psnr_db").is_null());
  for (const auto& [key, value] : json.items())
    EXPECT_TRUE(value.is_number() || value.is_null()) << key;
}

TEST_F(Compare, LayersOfDifferentNamesAndAScale) {
  const auto result = run_program("compare --json --layer indirect= --scale 2 " + a + " " + b);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_NEAR(nlohmann::json::parse(result.output).at("mean_ratio").get<double>(), 0.6 / 0.7, 1e-5);
}

TEST_F(Compare, NoiseOfTheReferenceIsSubtracted) {
  ASSERT_TRUE(write_exr(directory.file("se.exr"), {16, 8, {{"", Image(16, 8, 3)}}}));
  const auto result = run_program("compare --json --layer indirect --block 4 --noise " +
                                  directory.file("se.exr") + " " + a + " " + b);
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_NEAR(json.at("noise_corrected_relative_rmse").get<double>(), 0.5, 1e-5);
}

TEST_F(Compare, WritesAHeatMapThatIsAPicture) {
  const std::string path = directory.file("heat.png");
  const auto result = run_program("compare --layer indirect --heatmap " + path + " " + a + " " + b);
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto picture = read_image(path);
  ASSERT_TRUE(picture) << picture.error().message();
  EXPECT_GT(picture->width, 512);
  const float* too_bright = picture->find("")->at(100, 60);
  EXPECT_GT(too_bright[0], 2.0f * too_bright[2]);  // A is 50 % brighter: red.
}

TEST_F(Compare, BadInputIsStatus2WithAMessageAndNoOutput) {
  ASSERT_TRUE(write_exr(directory.file("small.exr"), {8, 8, {{"", Image(8, 8, 3)}}}));
  const std::string heat = "/dev/null/heat.png";
  const std::pair<std::string, std::string> cases[] = {
      {"compare " + a + " " + directory.file("none.exr"), "no such file"},
      {"compare " + a + " " + directory.file("small.exr"), "differ in size"},
      {"compare --layer glossy " + a + " " + b, "layer glossy: not in the file"},
      {"compare --layer indirect=glossy " + a + " " + b, "layer glossy: not in the file"},
      {"compare --heatmap " + directory.file("heat.exr") + " " + a + " " + b, "must end in .png"},
      {"compare --block 0 " + a + " " + b, "block"},
      {"compare --scale nan " + a + " " + b, "--scale"},
      {"compare --noise " + directory.file("small.exr") + " --layer direct " + a + " " + b,
       "standard error"},
      {"compare --frobnicate " + a + " " + b, "frobnicate"},
      {"compare " + a, "B"},
  };
  for (const auto& [arguments, message] : cases) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_NE(result.errors.find(message), std::string::npos) << arguments << "\n" << result.errors;
    EXPECT_EQ(result.output, "") << arguments;
  }
  const auto unwritable = run_program("compare --heatmap " + heat + " " + a + " " + b);
  EXPECT_EQ(unwritable.status, 1);
  EXPECT_NE(unwritable.errors.find("cannot make the folder /dev/null"), std::string::npos);
}

}  // namespace
}  // namespace lambent::compare_test
