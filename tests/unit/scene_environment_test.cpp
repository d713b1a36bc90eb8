// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "lambent/scene.h"

namespace lambent::scene_environment_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class LoadEnvironment : public testing::Test {
 protected:
  ~LoadEnvironment() override { std::filesystem::remove(path_); }

  // Writes a 2 x 1 picture beside another layer.
  void write(const std::vector<float>& pixels) const {
    LayeredImage image;
    image.width = 2;
    image.height = 1;
    image.require("normal", 3);
    image.require("", 3).pixels = pixels;
    ASSERT_TRUE(write_exr(path_, image));
  }

  std::string path_ = testing::TempDir() + "environment.exr";
};

TEST_F(LoadEnvironment, KeepsTheRadianceOfThePicture) {
  write({1, 2, 3, 1000, 5, 6});
  const Expected<Environment> environment = load_environment(path_);
  ASSERT_TRUE(environment) << environment.error().message();
  EXPECT_EQ(environment->radiance, glm::vec3(1.0f));
  EXPECT_EQ(environment->map.width, 2);
  EXPECT_THAT(environment->map.pixels, ElementsAre(1, 2, 3, 1000, 5, 6));
}

TEST_F(LoadEnvironment, NegativeLobesOfResamplingBecomeBlack) {
  write({-0.5f, 2, 3, 4, 5, 6});
  const Expected<Environment> environment = load_environment(path_);
  ASSERT_TRUE(environment) << environment.error().message();
  EXPECT_EQ(environment->map.pixels[0], 0.0f);
}

TEST_F(LoadEnvironment, RadianceThatIsNotANumberNamesThePixel) {
  write({1, 2, 3, 4, std::numeric_limits<float>::quiet_NaN(), 6});
  const Expected<Environment> environment = load_environment(path_);
  ASSERT_FALSE(environment);
  EXPECT_EQ(environment.error().place, "pixel (1, 0)");
}

TEST_F(LoadEnvironment, RadianceOutOfRangeNamesThePixel) {
  for (const float bright : {2e10f, 1e38f}) {
    write({1, 2, 3, 4, 5, bright});
    const Expected<Environment> environment = load_environment(path_);
    ASSERT_FALSE(environment);
    EXPECT_EQ(environment.error().place, "pixel (1, 0)");
    EXPECT_THAT(environment.error().cause, HasSubstr("above 1e10 W/(m^2 sr)"));
  }
}

TEST_F(LoadEnvironment, MissingAndBrokenFilesAreErrors) {
  EXPECT_FALSE(load_environment(testing::TempDir() + "none.exr"));
  std::ofstream(path_) << "no picture";
  const Expected<Environment> environment = load_environment(path_);
  ASSERT_FALSE(environment);
  EXPECT_THAT(environment.error().message(), HasSubstr("environment.exr"));
}

}  // namespace
}  // namespace lambent::scene_environment_test
