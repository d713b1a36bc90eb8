// SPDX-License-Identifier: Apache-2.0
// Finer probes around cameras in scenes that are far larger than what they see.
#include <gtest/gtest.h>

#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "support/box_scenes.h"

namespace lambent::near_volume_test {
namespace {

using test::box_mesh;
using test::scene_of;

constexpr glm::vec3 kLow{-2, 0, -3}, kHigh{2, 2.5f, 3};

/// A room of 4 x 2.5 x 6 m, on a ground of 400 m if `grounded`.
Scene room(bool grounded) {
  std::vector<Mesh> meshes = {box_mesh(kLow, kHigh)};
  if (grounded) meshes.push_back(box_mesh({-200, -1, -200}, {200, -0.01f, 200}));
  return scene_of(std::move(meshes));
}

const Camera kInside = look_at({0, 1.5f, 2}, {0, 1, -3}, 1.0f);

TEST(NearVolume, FillsTheRoomOfACameraWhereTheGridIsFarCoarser) {
  const Scene scene = room(true);
  const World world(scene);
  const auto volume = near_volume(world, kInside, glm::vec3(25.0f));
  ASSERT_TRUE(volume);
  // A grid is at most a cell off, and there are cells enough
  const float margin = volume->size.x / static_cast<float>(volume->probe_count.x - 1);
  EXPECT_LT(margin, 0.5f);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(volume->centre[axis] - 0.5f * volume->size[axis], kLow[axis], margin);
    EXPECT_NEAR(volume->centre[axis] + 0.5f * volume->size[axis], kHigh[axis], margin);
  }
}

TEST(NearVolume, HoldsAHouseThatACameraSeesInWideGrounds) {
  const glm::vec3 low(-4, 0, -3), high(4, 5, 3);
  const Scene scene =
      scene_of({box_mesh(low, high), box_mesh({-200, -1, -200}, {200, -0.01f, 200})});
  const World world(scene);
  const auto volume = near_volume(world, look_at({9, 3, 21}, {0, 2, 0}, 0.9f), glm::vec3(15.0f));
  ASSERT_TRUE(volume);
  // The rooms behind the walls that the camera sees are in it, too
  EXPECT_TRUE(glm::all(glm::lessThan(volume->centre - 0.5f * volume->size, low + 0.5f)));
  EXPECT_TRUE(glm::all(glm::greaterThan(volume->centre + 0.5f * volume->size, high - 0.5f)));
  EXPECT_LT(volume->size.x / static_cast<float>(volume->probe_count.x - 1), 2.0f);
  // Where the grid is less coarse, it is enough
  EXPECT_FALSE(near_volume(world, look_at({9, 3, 21}, {0, 2, 0}, 0.9f), glm::vec3(5.0f)));
}

TEST(NearVolume, IsNotThereWhereTheGridHasCellsEnough) {
  const Scene scene = room(false);
  const World world(scene);
  EXPECT_FALSE(near_volume(world, kInside, glm::vec3(0.4f)));
}

TEST(NearVolume, IsNotThereInTheOpen) {
  const Scene scene = room(true);
  const World world(scene);
  const Camera above = look_at({0, 150, 0}, {200, 160, 0}, 1.0f);
  EXPECT_FALSE(near_volume(world, above, glm::vec3(25.0f)));
}

}  // namespace
}  // namespace lambent::near_volume_test
