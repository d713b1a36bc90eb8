// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent {
namespace {

using ::testing::HasSubstr;
using testing::run_program;

class Picture : public ::testing::Test {
 protected:
  void SetUp() override {
    LayeredImage image{2, 1, {}};
    image.require("", 3);
    Image& lit = image.require("direct", 3);
    for (float& value : lit.pixels) value = 0.25f;
    ASSERT_TRUE(write_exr(input, image));
  }
  testing::TemporaryDirectory directory;
  std::string input = directory.file("in.exr"), output = directory.file("out.png");
};

TEST_F(Picture, ShowsALayerAtAnExposure) {
  const auto result = run_program("picture " + input + " -o " + output +
                                  " --layer direct --exposure 1 --tone-map linear");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto picture = read_image(output);
  ASSERT_TRUE(picture) << picture.error().message();
  constexpr float kHalfALevel = 0.5f / 255.0f;
  EXPECT_NEAR(picture->find("")->at(0, 0)[0], 0.5f, 2.0f * kHalfALevel);
}

TEST_F(Picture, BadInputIsStatus2WithAMessageAndNoOutput) {
  const std::string to = " -o " + output + " ";
  const std::pair<std::string, std::string> cases[] = {
      {"picture " + directory.file("none.exr") + to, "no such file"},
      {"picture " + input + " -o " + directory.file("out.exr"), "must end in .png"},
      {"picture " + input + " -o " + directory.file("none/out.png"), "cannot write"},
      {"picture " + input + to + "--layer fog", "layer fog: not in the file"},
      {"picture " + input + to + "--exposure bright", "bright"},
      {"picture " + input + to + "--exposure inf", "inf"},
      {"picture " + input + to + "--tone-map sepia", "sepia"},
  };
  for (const auto& [arguments, message] : cases) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr(message)) << arguments;
    EXPECT_EQ(directory.entries(), 1u) << arguments;
  }
}

}  // namespace
}  // namespace lambent
