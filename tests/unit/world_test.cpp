// SPDX-License-Identifier: Apache-2.0
#include "lambent/world.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "support/hand_made.h"

namespace lambent::world_test {
namespace {

TEST(World, ThrowsTheReasonWhereItsSceneIsNotValid) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  test::add_room(scene, 4.0f, 0);
  scene.meshes.at(0).triangles.at(0).x = 1000;
  try {
    const World world(scene);
    FAIL() << "a triangle without a corner was accepted";
  } catch (const std::invalid_argument& refused) {
    EXPECT_EQ(std::string(refused.what()), validate(scene).error().message());
  }
}

}  // namespace
}  // namespace lambent::world_test
