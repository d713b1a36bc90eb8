// SPDX-License-Identifier: Apache-2.0
// Finer probes around cameras in scenes that are larger than what they see.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "lambent/field.h"
#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "support/box_scenes.h"

namespace lambent::near_volumes_test {
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

/// A grid of this spacing along all axes around a ground of 400 m.
FieldGrid grid_of(float spacing) {
  FieldGrid grid;
  grid.spacing = glm::vec3(spacing);
  grid.count = glm::ivec3(glm::ceil(glm::vec3(400, 20, 400) / spacing)) + 1;
  grid.origin = {-200, -1, -200};
  return grid;
}

float spacing_of(const ProbeVolume& volume) {
  const glm::vec3 spacing = volume.size / glm::vec3(volume.probe_count - 1);
  return std::max({spacing.x, spacing.y, spacing.z});
}

float probes_of(const ProbeVolume& volume) {
  const glm::ivec3 count = volume.probe_count;
  return static_cast<float>(count.x * count.y * count.z);
}

const Camera kInside = look_at({0, 1.5f, 2}, {0, 1, -3}, 1.0f);

TEST(NearVolumes, FillTheRoomOfACameraWhereTheGridIsFarCoarser) {
  const Scene scene = room(true);
  const World world(scene);
  const auto volumes = near_volumes(world, kInside, grid_of(25.0f));
  ASSERT_FALSE(volumes.empty());
  const ProbeVolume* volume = volumes.data();
  // A grid is at most a cell off, and there are cells enough
  const float margin = volume->size.x / static_cast<float>(volume->probe_count.x - 1);
  EXPECT_LT(margin, 0.5f);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(volume->centre[axis] - 0.5f * volume->size[axis], kLow[axis], margin);
    EXPECT_NEAR(volume->centre[axis] + 0.5f * volume->size[axis], kHigh[axis], margin);
  }
}

TEST(NearVolumes, StandWithinOthersWhoseSpacingGrowsInSteps) {
  const Scene scene = room(true);
  const World world(scene);
  const FieldGrid grid = grid_of(25.0f);
  const auto volumes = near_volumes(world, kInside, grid);
  ASSERT_GE(volumes.size(), 2u);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const bool last = i + 1 == volumes.size();
    const float coarser = last ? grid.spacing.x : spacing_of(volumes[i + 1]);
    EXPECT_GT(coarser, spacing_of(volumes[i]));
    // The bounds of the grid cut off the last one, below and above, which makes it finer
    EXPECT_LT(coarser, (last ? 4.0f : 2.5f) * spacing_of(volumes[i])) << i;
    if (last) break;
    // What stands beside the room is in the next one
    const glm::vec3 low = volumes[i].centre - 0.5f * volumes[i].size;
    const glm::vec3 next_low = volumes[i + 1].centre - 0.5f * volumes[i + 1].size;
    EXPECT_LT(next_low.x, low.x - 0.5f * volumes[i].size.x);
    EXPECT_LT(next_low.z, low.z - 0.5f * volumes[i].size.z);
    // None is below the ground
    EXPECT_GT(next_low.y, -1.01f);
  }
}

TEST(NearVolumes, HoldAHouseThatACameraSeesInWideGrounds) {
  const glm::vec3 low(-4, 0, -3), high(4, 5, 3);
  const Scene scene =
      scene_of({box_mesh(low, high), box_mesh({-200, -1, -200}, {200, -0.01f, 200})});
  const World world(scene);
  const Camera camera = look_at({9, 3, 21}, {0, 2, 0}, 0.9f);
  const auto volumes = near_volumes(world, camera, grid_of(15.0f));
  ASSERT_FALSE(volumes.empty());
  const ProbeVolume* volume = volumes.data();
  // The rooms behind the walls that the camera sees are in it, too
  EXPECT_TRUE(glm::all(glm::lessThan(volume->centre - 0.5f * volume->size, low + 0.5f)));
  EXPECT_TRUE(glm::all(glm::greaterThan(volume->centre + 0.5f * volume->size, high - 0.5f)));
  EXPECT_LT(volume->size.x / static_cast<float>(volume->probe_count.x - 1), 2.0f);
  // Where the grid is less coarse, it is enough
  EXPECT_TRUE(near_volumes(world, camera, grid_of(5.0f)).empty());
}

TEST(NearVolumes, AreNotThereWhereTheGridHasCellsEnough) {
  const Scene scene = room(false);
  const World world(scene);
  EXPECT_TRUE(near_volumes(world, kInside, grid_of(0.4f)).empty());
}

TEST(NearVolumes, FillALongRoomThatIsAsHighAsFewCells) {
  const Scene scene = room(true);
  const World world(scene);
  // Six cells of the grid are as long as the room, but not three as high
  const auto volumes = near_volumes(world, kInside, grid_of(1.0f));
  ASSERT_FALSE(volumes.empty());
  EXPECT_LT(spacing_of(volumes.front()), 0.35f);
}

TEST(NearVolumes, AreNotThereWhereTheyWouldHardlyBeFiner) {
  // The room is as high as 3.75 cells of 0.32 m; 4,096 probes in it are some 0.19 m apart
  const Scene scene = scene_of({box_mesh({-2, 0, -3}, {2, 1.2f, 3})});
  const World world(scene);
  const Camera camera = look_at({0, 0.6f, 2}, {0, 0.6f, -3}, 1.0f);
  EXPECT_FALSE(near_volumes(world, camera, grid_of(0.64f)).empty());
  EXPECT_TRUE(near_volumes(world, camera, grid_of(0.32f)).empty());
}

TEST(NearVolumes, HoldTheWholePathOfACameraThatTravels) {
  // A lift of 2 m that climbs 12 m
  const std::vector<Bounds> boxes = {{glm::vec3(0.0f), glm::vec3(2.0f)},
                                     {{0.0f, 6.0f, 0.0f}, {2.0f, 8.0f, 2.0f}},
                                     {{0.0f, 10.0f, 0.0f}, {2.0f, 12.0f, 2.0f}}};
  const auto volumes = near_volumes(boxes, grid_of(5.0f));
  const auto first = near_volumes(std::span(boxes).first(1), grid_of(5.0f));
  ASSERT_FALSE(volumes.empty());
  // A grid is at most a cell off
  const glm::vec3 half(0.5f * volumes[0].size + spacing_of(volumes[0]));
  const glm::vec3 low = volumes[0].centre - half, high = volumes[0].centre + half;
  for (const Bounds& box : boxes) {
    EXPECT_TRUE(glm::all(glm::lessThanEqual(low, box.min)));
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(high, box.max)));
  }
  // Four times the probes for six times the space
  EXPECT_NEAR(probes_of(volumes[0]), 4.0f * probes_of(first[0]), 0.8f * probes_of(first[0]));
  EXPECT_TRUE(near_volumes(std::span<const Bounds>(), grid_of(5.0f)).empty());
}

TEST(NearVolumes, AreNotThereBeyondTheGrid) {
  const FieldGrid grid = grid_of(25.0f);
  const Bounds beside{{-2, 0, -3}, {2, 2, 3}}, beyond{{-2, -90, -3}, {2, -80, 3}};
  EXPECT_FALSE(near_volumes(std::span(&beside, 1), grid).empty());
  EXPECT_TRUE(near_volumes(std::span(&beyond, 1), grid).empty());
}

TEST(NearVolumes, AreNotThereInTheOpen) {
  const Scene scene = room(true);
  const World world(scene);
  const Camera above = look_at({0, 150, 0}, {200, 160, 0}, 1.0f);
  EXPECT_TRUE(near_volumes(world, above, grid_of(25.0f)).empty());
}

}  // namespace
}  // namespace lambent::near_volumes_test
