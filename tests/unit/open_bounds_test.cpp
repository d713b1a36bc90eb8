// SPDX-License-Identifier: Apache-2.0
// Where a scene's open space ends, for viewers inside and outside.
#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "lambent/field.h"
#include "lambent/world.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::open_bounds_test {
namespace {

using glm::vec3;
using test::box_mesh;
using test::scene_of;

/// Inner and outer reach of the walls of a room around the origin [m].
constexpr float kInside = 2.5f, kOutside = 2.7f;

Scene room() {
  Scene scene = scene_of({box_mesh(vec3(-kOutside), vec3(kOutside)),
                          box_mesh(vec3(-kInside), vec3(kInside), /*inwards=*/true)});
  scene.lights.push_back(test::point_light(vec3(10.0f), vec3(0.2f, 0.1f, 0.3f)));
  return scene;
}

TEST(OpenBounds, EndAtTheInsidesOfARoomsWalls) {
  const Scene scene = room();
  const World world(scene);
  for (const Bounds& open : {open_bounds(world), open_bounds(world, vec3(1.0f, 0.0f, -2.0f))}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(open.min[axis], -kInside, 1e-3f);
      EXPECT_NEAR(open.max[axis], kInside, 1e-3f);
    }
  }
}

TEST(OpenBounds, ReachOutOfTheWallsThatAViewerFaces) {
  const Scene scene = room();
  const World world(scene);
  const Bounds open = open_bounds(world, vec3(9.0f, 0.5f, -8.0f));
  EXPECT_GT(open.max.x, kOutside + 0.1f);
  EXPECT_LT(open.min.z, -kOutside - 0.1f);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != 2) {
      EXPECT_NEAR(open.min[axis], -kInside, 1e-3f) << axis;
    }
    if (axis != 0) {
      EXPECT_NEAR(open.max[axis], kInside, 1e-3f) << axis;
    }
  }
}

// The statue has most of the scene's triangles, so that the room is taken for a stray.
TEST(OpenBounds, AreThoseOfTheRoomThatAViewerStandsInHoweverFarItIsFromTheRest) {
  constexpr float kAway = 200.0f;
  Scene scene = room();
  test::add(scene, test::sphere(0.5f, 12, 0), glm::translate(glm::mat4(1.0f), vec3(kAway)));
  const World world(scene);
  const Bounds statue = open_bounds(world), around = open_bounds(world, vec3(1.0f, 0.0f, -2.0f));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(statue.min[axis], kAway / 2.0f);
    EXPECT_NEAR(around.min[axis], -kInside, 1e-3f);
    EXPECT_NEAR(around.max[axis], kInside, 1e-3f);
  }
}

// A box that was left 50 m below a room's ground makes the bounds so high that the ground is within
// the depth of walls.
TEST(OpenBounds, HoldAViewerAboveWhatWasForgottenBelow) {
  const Scene scene = scene_of({box_mesh({-2, 0, -3}, {2, 2.7f, 11}, /*inwards=*/true),
                                test::quad({-100, -0.6f, -100}, {200, 0, 0}, {0, 0, 200}, 0),
                                box_mesh({-2.5f, -51, 3}, {2.5f, -49, 3.2f})});
  const World world(scene);
  const vec3 viewer(0.0f, 1.6f, -1.0f);
  const Bounds open = open_bounds(world, viewer);
  EXPECT_LT(open.min.y, -0.6f);
  EXPECT_GT(open.max.y, viewer.y);
}

// The wall is a single sheet, seen by air on both sides; nothing but the sky is in front of it.
TEST(FieldLight, IsTheSkysOnTheOutsideOfARoomThatIsSeenFromThere) {
  constexpr float kRadiance = 0.7f, kTolerance = 0.03f;
  Scene scene = scene_of({box_mesh(vec3(-kInside), vec3(kInside), /*inwards=*/true)});
  scene.lights.push_back(test::point_light(vec3(10.0f), vec3(0.2f, 0.1f, 0.3f)));
  scene.environment.radiance = vec3(kRadiance);
  const World world(scene);
  const Bounds bounds = open_bounds(world, vec3(9.0f, 0.0f, 0.0f));
  FieldSettings settings;
  settings.probe_count = glm::ivec3(7);
  IrradianceField field = IrradianceField::make(settings, bounds).value();
  for (int i = 0; i < 4; ++i) field.update(world);
  const FieldQuery on_wall{vec3(kInside, 0.3f, -0.6f), vec3(1.0f, 0.0f, 0.0f),
                           vec3(1.0f, 0.0f, 0.0f)};
  vec3 found(0.0f);
  field.irradiance({&on_wall, 1}, {&found, 1});
  const float expected = glm::pi<float>() * kRadiance;
  EXPECT_NEAR(found.y, expected, kTolerance * expected);
}

}  // namespace
}  // namespace lambent::open_bounds_test
