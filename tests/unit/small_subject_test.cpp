// SPDX-License-Identifier: Apache-2.0
// First pictures of small things in the rooms around them.
#include <gtest/gtest.h>

#include "lambent/first_picture.h"
#include "raytracing/camera_rays.h"
#include "raytracing/trace_rays.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::small_subject_test {
namespace {

TEST(FirstView, ShowsASmallThingInTheRoomThatDwarfsIt) {
  // A board with its pieces in the middle of a closed room
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.6f))};
  test::add(scene, test::box_mesh({-4, 0, -4}, {4, 3, 4}, true));
  test::add(scene, test::box_mesh({-0.23f, 0.73f, -0.23f}, {0.23f, 0.75f, 0.23f}));
  for (int i = 0; i < 16; ++i) {
    const glm::vec3 at(-0.2f + 0.1f * static_cast<float>(i % 4), 0.75f,
                       -0.2f + 0.1f * static_cast<float>(i / 4));
    test::add(scene, test::box_mesh(at, at + glm::vec3(0.03f, 0.08f, 0.03f)));
  }
  const World world(scene);
  const FirstView view = first_view(world, {}).value();
  EXPECT_FALSE(view.inside);
  const Ray middle = camera_ray(view.camera, 64, 36, 32.0f, 18.0f);
  const Hit hit = trace(world, {&middle, 1}).front();
  ASSERT_FALSE(hit.missed());
  EXPECT_NE(hit.instance, 0u);
  EXPECT_LT(hit.distance, 2.0f);
}

TEST(FirstView, StandsInAShipBesideAPlanet) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.6f))};
  test::add(scene, test::box_mesh({-1.5f, 0, -12}, {1.5f, 2.8f, 12}, true));
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 at(-1.4f, 0.5f, -10.0f + 2.5f * static_cast<float>(i));
    test::add(scene, test::box_mesh(at, at + glm::vec3(0.4f, 0.8f, 1.2f)));
  }
  ASSERT_TRUE(first_view(World(scene), {}).value().inside);
  test::add(scene, test::box_mesh({-120, -20, -30}, {-60, 40, 30}));
  EXPECT_TRUE(first_view(World(scene), {}).value().inside);
  // The rest is no room
  scene.instances.erase(scene.instances.begin());
  EXPECT_FALSE(first_view(World(scene), {}).value().inside);
}

TEST(FirstView, TellsHowFarAwayIsWhatItShows) {
  for (const float size : {0.01f, 1.0f, 50.0f}) {
    const glm::vec3 low(3.0f, 1.0f, -2.0f);
    const Scene scene = test::scene_of({test::box_mesh(low, low + size)});
    const FirstView view = first_view(World(scene), {}).value();
    const glm::vec3 eye(view.camera.world_from_view[3]);
    const glm::vec3 target = eye - view.distance * glm::vec3(view.camera.world_from_view[2]);
    EXPECT_LT(glm::distance(target, low + 0.5f * size), size) << size;
  }
  // A frame, in whose middle nothing is
  const Scene frame = test::scene_of(
      {test::box_mesh({-50, -50, 0}, {50, -48, 2}), test::box_mesh({-50, 48, 0}, {50, 50, 2}),
       test::box_mesh({-50, -50, 0}, {-48, 50, 2}), test::box_mesh({48, -50, 0}, {50, 50, 2})});
  EXPECT_GT(first_view(World(frame), {}).value().distance, 50.0f);
}

}  // namespace
}  // namespace lambent::small_subject_test
