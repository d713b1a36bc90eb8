// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scene/prepared.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::prepare_test {
namespace {

using test::ProgramResult;
using test::run_program;
using testing::HasSubstr;

class Prepare : public testing::Test {
 protected:
  lambent::test::TemporaryDirectory folder;
};

TEST_F(Prepare, WritesTheSceneWithItsLightsAndTheCameraAsked) {
  const std::string path = folder.file("cornell.scene");
  const ProgramResult outcome =
      run_program("prepare cornell --sun=0,-1,0 --eye 1,2,3 --target 4,2,3 -o " + path);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("38 triangles"));
  const auto scene = lambent::load_prepared(path);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->lights.back().type, lambent::Light::Type::directional);
  EXPECT_EQ(glm::vec3(scene->cameras[0].world_from_view[3]), glm::vec3(1.0f, 2.0f, 3.0f));
}

TEST_F(Prepare, KeepsTexturesSmallWhereAsked) {
  const ProgramResult outcome =
      run_program("prepare atrium --texture-size 16 -o " + folder.file("small"));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto scene = lambent::load_prepared(folder.file("small"));
  ASSERT_TRUE(scene) << scene.error().message();
  int largest = 0;
  for (const lambent::Texture& texture : scene->textures) {
    largest = std::max(largest, texture.levels[0].width);
  }
  EXPECT_EQ(largest, 16);  // of 256 and more
}

TEST_F(Prepare, WritesNothingOfWhatIsNotThere) {
  const ProgramResult outcome = run_program("prepare nowhere.glb -o " + folder.file("a"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace lambent::prepare_test
