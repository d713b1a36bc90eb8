// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lambent/image.h"
#include "support/program.h"

namespace lambent::picture_test {
namespace {

using lambent::test::run_program;
using lambent::test::TemporaryDirectory;
using ::testing::HasSubstr;

/// A picture of radiance 0.5 whose layer "direct" has a quarter.
std::string write_layers(const TemporaryDirectory& directory) {
  LayeredImage image{4, 2, {}};
  for (float& value : image.require("", 3).pixels) value = 0.5f;
  for (float& value : image.require("direct", 3).pixels) value = 0.25f;
  const std::string path = directory.file("in.exr");
  EXPECT_TRUE(write_exr(path, image));
  return path;
}

TEST(Picture, ShowsTheLayerAtTheExposureAskedFor) {
  const TemporaryDirectory directory;
  const std::string out = directory.file("out.png");
  const auto run = run_program("picture " + write_layers(directory) +
                               " --layer direct --exposure 1 --tone-map linear -o " + out);
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto shown = read_image(out);
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->width, 4);
  // A quarter, one stop brighter, within half a step of 8 bits
  EXPECT_NEAR(shown->layers[0].image.pixels[0], 0.5f, 0.004f);
}

TEST(Picture, RejectsALayerThatIsNotThereAndWritesNothing) {
  const TemporaryDirectory directory;
  const auto run = run_program("picture " + write_layers(directory) + " --layer glossy -o " +
                               directory.file("out.png"));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("glossy"));
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(Picture, RejectsAnExposureThatIsNoNumber) {
  const TemporaryDirectory directory;
  const auto run = run_program("picture " + write_layers(directory) + " --exposure bright -o " +
                               directory.file("out.png"));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("--exposure"));
}

}  // namespace
}  // namespace lambent::picture_test
