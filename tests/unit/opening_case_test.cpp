// SPDX-License-Identifier: Apache-2.0
// First pictures of what animations open and move.
#include <gtest/gtest.h>

#include <cmath>

#include "lambent/animation.h"
#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"
#include "support/moving_scene.h"
#include "support/view_coverage.h"

namespace lambent::opening_case_test {
namespace {

/// A case 16 x 10 x 10 in units of `size` [m], whose lid an animation lifts from y = 10 to `high`
/// in a second, and turns upright. At rest, it is shut.
Scene opening_case(float size, float high) {
  const auto wall = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return test::quad(size * a, size * b, size * c, 0);
  };
  // Sheets whose fronts are within, and a thing on the bottom
  Scene scene = test::scene_of(
      {wall({0, 0, 0}, {0, 0, 10}, {16, 0, 0}), wall({0, 0, 0}, {16, 0, 0}, {0, 10, 0}),
       wall({16, 0, 10}, {-16, 0, 0}, {0, 10, 0}), wall({0, 0, 10}, {0, 0, -10}, {0, 10, 0}),
       wall({16, 0, 0}, {0, 0, 10}, {0, 10, 0}), wall({0, 0, 0}, {16, 0, 0}, {0, 0, 10}),
       test::box_mesh(size * glm::vec3(5, 0, 4), size * glm::vec3(9, 2, 7))});
  RigNode hinge;
  hinge.translation = {0.0, 10.0 * static_cast<double>(size), 0.0};
  scene.rig.nodes = {hinge};
  scene.rig.instances.push_back({5, 0, glm::dmat4(1.0)});
  Animation lift;
  using Target = Channel::Target;
  lift.channels = {
      test::channel(Target::node_translation, 0, 3, {0, 10 * size, 0, 0, high * size, 0}),
      test::channel(Target::node_rotation, 0, 4, {0, 0, 0, 1, -0.7071068f, 0, 0, 0.7071068f})};
  scene.animations.push_back(std::move(lift));
  rest(scene);
  return scene;
}

TEST(FirstView, ShowsACaseThatAnAnimationOpensFromOutside) {
  Scene scene = opening_case(0.006f, 10.0f);
  EXPECT_FALSE(first_view(World(scene)).value().inside) << "at rest, it is shut";
  animate(scene, -1, 1.0f);
  EXPECT_FALSE(first_view(World(scene)).value().inside) << "open";
  // Without an animation, nothing tells that what is shut is no model of a room
  rest(scene);
  scene.animations.clear();
  EXPECT_TRUE(first_view(World(scene)).value().inside);
  // A room in metres stays one when its roof is lifted
  scene = opening_case(0.3f, 10.0f);
  EXPECT_TRUE(first_view(World(scene)).value().inside);
}

TEST(FirstView, OfASequenceHasAllInTheFrameInEachPose) {
  Scene scene = opening_case(0.006f, 40.0f);
  World world(scene);
  constexpr int kPoses = 5;
  int taken = -1;
  const auto take = [&](int pose) -> Expected<void> {
    taken = pose;
    animate(scene, -1, static_cast<float>(pose) / (kPoses - 1));
    const auto changes = world.update();
    if (!changes) return tl::unexpected(changes.error());
    return {};
  };
  const FirstView view = first_view(world, {}, {kPoses, take}).value();
  EXPECT_FALSE(view.inside);
  EXPECT_EQ(taken, 0) << "the first pose stays";
  const FirstView first = first_view(world).value();
  float most = 0.0f;
  for (int pose = 0; pose < kPoses; ++pose) {
    ASSERT_TRUE(take(pose));
    const test::Coverage coverage = test::coverage_of(world, view.camera);
    EXPECT_FALSE(coverage.cut) << pose;
    most = std::max(most, coverage.extent);
  }
  EXPECT_GE(most, 0.5f) << "and no smaller than that needs";
  // In the last pose, the lid is above what the first one's view shows
  const auto shows_lid = [&](const Camera& camera) {
    const Bounds lid = world.instance_bounds(5);
    const glm::vec4 center(0.5f * (lid.min + lid.max), 1.0f);
    const glm::vec4 p = glm::inverse(camera.world_from_view) * center;
    return std::abs(p.y) <= -p.z * std::tan(0.5f * camera.vertical_fov);
  };
  EXPECT_TRUE(shows_lid(view.camera));
  EXPECT_FALSE(shows_lid(first.camera));
}

TEST(FirstView, OfASequenceFailsWhereAPoseDoes) {
  const Scene scene = opening_case(0.006f, 18.0f);
  const World world(scene);
  const auto refuse = [](int) -> Expected<void> { return fail("pose", "", "cannot be taken"); };
  EXPECT_FALSE(first_view(world, {}, {3, refuse}));
  EXPECT_FALSE(first_view(world, {}, {0, refuse})) << "no pose";
  EXPECT_FALSE(first_view(world, {}, {2, {}})) << "no way to take them";
}

}  // namespace
}  // namespace lambent::opening_case_test
