// SPDX-License-Identifier: Apache-2.0
// Where the first picture is taken from, in scenes that nobody described.
#include <gtest/gtest.h>

#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "lambent/first_picture.h"
#include "raytracing/world_access.h"
#include "scenes/builtin.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"
#include "support/view_coverage.h"

namespace lambent::first_view_test {
namespace {

using test::box_mesh;
using test::Coverage;
using test::coverage_of;
using test::scene_of;

glm::vec3 eye_of(const Camera& camera) {
  return glm::vec3(camera.world_from_view[3]);
}

bool holds(const Bounds& bounds, const glm::vec3& p) {
  return glm::all(glm::greaterThan(p, bounds.min)) && glm::all(glm::lessThan(p, bounds.max));
}

/// A built-in scene without its cameras.
Scene without_cameras(const std::string& name) {
  Scene scene = scenes::make(name).value();
  scene.cameras.clear();
  return scene;
}

TEST(FirstView, ShowsAClosedBoxFromOutside) {
  const Scene scene = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  const World world(scene);
  const FirstView view = first_view(world).value();
  EXPECT_FALSE(view.inside);
  const Coverage coverage = coverage_of(world, view.camera);
  EXPECT_GT(coverage.met, 0.2f);
  EXPECT_LT(coverage.met, 0.8f);
  EXPECT_FALSE(coverage.cut);
  EXPECT_EQ(coverage.backs, 0.0f);
}

TEST(FirstView, KnowsWhetherACameraSeesAnything) {
  const Scene scene = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  const World world(scene);
  constexpr float kFov = 0.8f, kWide = 16.0f / 9.0f;
  const Camera at = look_at({0, 0, 9}, {0, 0, 0}, kFov),
               away = look_at({0, 0, 9}, {0, 0, 20}, kFov);
  // The box is to the right of a picture as high as wide, and in a wide one
  const Camera beside = look_at({0, 0, 9}, {-6.2f, 0, 0}, kFov);
  EXPECT_TRUE(sees_a_surface(world, at, kWide));
  EXPECT_FALSE(sees_a_surface(world, away, kWide));
  EXPECT_TRUE(sees_a_surface(world, beside, kWide));
  EXPECT_FALSE(sees_a_surface(world, beside, 1.0f));
  Camera parallel = beside;
  parallel.orthographic = true;
  parallel.vertical_extent = 1.0f;
  EXPECT_FALSE(sees_a_surface(world, parallel, kWide));
  parallel.vertical_extent = 30.0f;
  EXPECT_TRUE(sees_a_surface(world, parallel, kWide));
}

TEST(FirstView, LooksDownOnThingsFromTheFront) {
  const Scene scene = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  const glm::vec3 eye = eye_of(first_view(World(scene)).value().camera);
  EXPECT_GT(eye.z, std::abs(eye.x));
  EXPECT_GT(eye.y, 0.0f);
  EXPECT_LT(eye.y, eye.z);
}

TEST(FirstView, OfKitchensStandsOnTheirFloors) {
  for (int i = 0; i < 12; ++i) {
    const float wide = 3.2f + 0.15f * static_cast<float>(i);
    // Worktops with cupboards above them, and a table; lamps light the worktops
    Scene scene = scene_of({box_mesh({0, 0, 0}, {wide, 2.5f, 3.4f}, true),
                            box_mesh({0, 0, 0}, {wide - 0.9f, 0.92f, 0.63f}),
                            box_mesh({0, 1.47f, 0}, {wide - 0.9f, 2.2f, 0.35f}),
                            box_mesh({wide - 0.85f, 0, 0}, {wide - 0.05f, 1.9f, 0.7f}),
                            box_mesh({1.2f, 0.72f, 1.8f}, {wide - 0.6f, 0.75f, 2.6f}),
                            box_mesh({0.05f, 1.455f, 0.12f}, {wide - 1, 1.469f, 0.15f})});
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].emission = vec3(40.0f);
    scene.meshes.back().material = 1;
    const FirstView view = first_view(World(scene)).value();
    ASSERT_TRUE(view.inside);
    // At 0.6 of the room's height
    EXPECT_NEAR(eye_of(view.camera).y, 1.5f, 0.01f) << wide;
  }
}

TEST(FirstView, FitsObjectsOfAnyShapeSizeAndPlace) {
  const glm::vec3 sizes[] = {{1, 1, 1}, {20, 1, 1}, {1, 20, 1}, {1, 1, 20}, {10, 10, 0.1f}};
  for (const float scale : {1e-4f, 1.0f, 1e4f}) {
    for (const glm::vec3& size : sizes) {
      const glm::vec3 low = scale * glm::vec3(30.0f, -10.0f, 5.0f);
      const Scene scene = scene_of({box_mesh(low, low + scale * size)});
      const World world(scene);
      const Coverage coverage = coverage_of(world, first_view(world).value().camera, 192, 108);
      EXPECT_FALSE(coverage.cut) << scale << ": " << size.x << " " << size.y << " " << size.z;
      EXPECT_GT(coverage.met, 0.02f) << scale << ": " << size.x << " " << size.y << " " << size.z;
    }
  }
}

TEST(FirstView, LeavesOutStraysThatAreFarAway) {
  // Two of them, in two directions, around five boxes on a ground that dwarfs these
  std::vector<Mesh> meshes;
  for (int i = 0; i < 5; ++i) {
    const vec3 low(3.0f * static_cast<float>(i), 0.0f, static_cast<float>(i % 2));
    meshes.push_back(box_mesh(low, low + vec3(2.0f)));
  }
  meshes.push_back(box_mesh({-60, -1, -60}, {60, 0, 60}));
  const Scene alone = scene_of(meshes);
  meshes.push_back(box_mesh({9000, -40, 3000}, {9001, -39, 3001}));
  meshes.push_back(box_mesh({-7000, 900, 0}, {-6998, 902, 2}));
  const Scene scene = scene_of(meshes);
  const World world(scene), before(alone);
  EXPECT_EQ(first_view(world).value().camera.world_from_view,
            first_view(before).value().camera.world_from_view);
  EXPECT_EQ(open_bounds(world), open_bounds(before));
  // Things as far from each other as planets are no strays
  const Scene planets = scene_of({box_mesh({0, 0, 0}, {2, 2, 2}), box_mesh({9, 0, 0}, {11, 2, 2}),
                                  box_mesh({38, 0, 0}, {40, 2, 2})});
  EXPECT_EQ(find_subject(World(planets)).instances.size(), 3u);
}

TEST(FirstView, IsFromTheFrontOfABackdropWhoseTrianglesFaceBackwards) {
  Scene scene = scene_of({box_mesh({-0.2f, 0, -0.2f}, {0.2f, 0.5f, 0.2f})});
  // A floor and a wall behind
  test::add(scene, test::quad({-2, 0, -1.5f}, {4, 0, 0}, {0, 0, 3}, 0));
  test::add(scene, test::quad({-2, 0, -1.5f}, {0, 2, 0}, {4, 0, 0}, 0));
  EXPECT_GT(eye_of(first_view(World(scene)).value().camera).z, 0.0f);
}

TEST(FirstView, KeepsTheWholeObjectInFramesOfAnyShape) {
  const Scene scene = scene_of({box_mesh({-1, -1, -1}, {3, 1, 1})});
  const World world(scene);
  for (const float aspect : {0.25f, 1.0f, 4.0f}) {
    const Camera camera = first_view(world, {.vertical_fov = {}, .aspect = aspect}).value().camera;
    const Coverage coverage = coverage_of(world, camera, static_cast<int>(96.0f * aspect), 96);
    EXPECT_FALSE(coverage.cut) << aspect;
    EXPECT_GT(coverage.met, 0.08f) << aspect;
  }
}

TEST(FirstView, SeesAOneSidedSheetFromItsFront) {
  for (const float facing : {1.0f, -1.0f}) {
    Scene scene;
    scene.materials.push_back(test::lambert(glm::vec3(0.5f)));
    test::add(scene, test::quad({-facing, -1, 0}, {2 * facing, 0, 0}, {0, 2, 0}, 0));
    const World world(scene);
    const Coverage coverage = coverage_of(world, first_view(world).value().camera);
    EXPECT_GT(coverage.met, 0.15f) << facing;
    EXPECT_EQ(coverage.backs, 0.0f) << facing;
  }
}

TEST(FirstView, LooksDownOnGroundThatIsFlat) {
  Scene scene;
  scene.materials.push_back(test::lambert(glm::vec3(0.5f)));
  test::add(scene, test::quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0));
  const World world(scene);
  EXPECT_GT(coverage_of(world, first_view(world).value().camera).met, 0.15f);
}

TEST(FirstView, FramesTheThingAndNotTheGroundItStandsOn) {
  Scene scene =
      scene_of({box_mesh({-1, 0, -1}, {1, 2, 1}), box_mesh({-500, -1, -500}, {500, 0, 500})});
  const World world(scene);
  const glm::vec3 eye = eye_of(first_view(world).value().camera);
  EXPECT_LT(glm::length(eye), 12.0f);
}

TEST(FirstView, FramesTheThingAndNotTheStudioItStandsIn) {
  // A sweep of paper below and behind a box that is sunk into it, and panels of light, one in a
  // housing
  Scene scene =
      scene_of({box_mesh({-0.4f, -0.01f, -0.4f}, {0.4f, 0.8f, 0.4f}), test::sweep_mesh()});
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].emission = vec3(10.0f);
  test::add(scene, test::quad({-2, 2.5f, -1}, {4, 0, 0}, {0, 0, 2}, 1));
  test::add(scene, test::quad({-2.5f, 0.5f, -1}, {0, 1, 0}, {0, 0, 2}, 1));
  test::add(scene, box_mesh({-2.7f, 0.4f, -1.1f}, {-2.52f, 1.6f, 1.1f}));
  const World world(scene);
  EXPECT_EQ(find_subject(world).instances, std::vector<std::uint32_t>{0});
  EXPECT_EQ(find_subject(world).site, world_bounds(scene));
  const glm::vec3 eye = eye_of(first_view(world).value().camera);
  EXPECT_GT(eye.z, 0.0f);
  EXPECT_LT(glm::length(eye), 4.0f);
}

TEST(FirstView, FramesAThingThatWasPutThroughThePaper) {
  const Scene scene =
      scene_of({box_mesh({-0.4f, -0.35f, -0.4f}, {0.4f, 0.4f, 0.4f}), test::sweep_mesh()});
  EXPECT_EQ(find_subject(World(scene)).instances, std::vector<std::uint32_t>{0});
}

TEST(FirstView, DoesNotTakeTheWallsOfAnEmptyRoomForAStudio) {
  const Mesh thing = box_mesh({-0.4f, 0, -0.4f}, {0.4f, 0.8f, 0.4f});
  const Scene one_mesh = scene_of({thing, box_mesh({-3, 0, -2}, {3, 3, 2}, true)});
  EXPECT_EQ(find_subject(World(one_mesh)).instances.size(), 2u);
  // A room of six walls
  Scene scene = scene_of({thing});
  test::add(scene, test::quad({-3, 0, -2}, {6, 0, 0}, {0, 0, 4}, 0));
  test::add(scene, test::quad({-3, 3, -2}, {6, 0, 0}, {0, 0, 4}, 0));
  test::add(scene, test::quad({-3, 0, -2}, {0, 3, 0}, {6, 0, 0}, 0));
  test::add(scene, test::quad({-3, 0, 2}, {0, 3, 0}, {6, 0, 0}, 0));
  test::add(scene, test::quad({-3, 0, -2}, {0, 3, 0}, {0, 0, 4}, 0));
  test::add(scene, test::quad({3, 0, -2}, {0, 3, 0}, {0, 0, 4}, 0));
  EXPECT_EQ(find_subject(World(scene)).instances.size(), scene.instances.size());
}

TEST(FirstView, FramesWhatGlowsOnAGround) {
  // A cube that glows, and a pebble, stand on a wide ground
  Scene scene =
      scene_of({box_mesh({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}),
                box_mesh({1.0f, 0, 0}, {1.1f, 0.1f, 0.1f}), box_mesh({-50, -1, -50}, {50, 0, 50})});
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].emission = vec3(10.0f);
  scene.meshes[0].material = 1;
  EXPECT_EQ(find_subject(World(scene)).instances.size(), 2u);
}

TEST(FirstView, StandsInARoom) {
  for (const char* name : {"two-rooms", "two-rooms-sealed", "cornell", "atrium", "house"}) {
    const Scene scene = without_cameras(name);
    const World world(scene);
    const FirstView view = first_view(world).value();
    const Bounds bounds = world_bounds(scene);
    EXPECT_TRUE(view.inside) << name;
    EXPECT_TRUE(holds(bounds, eye_of(view.camera))) << name;
    EXPECT_LT(coverage_of(world, view.camera).backs, 0.2f) << name;
  }
}

TEST(FirstView, SeesDeepIntoARoom) {
  for (const char* name : {"cornell", "two-rooms"}) {
    const Scene scene = without_cameras(name);
    const World world(scene);
    const Coverage coverage = coverage_of(world, first_view(world).value().camera);
    EXPECT_GT(coverage.median_depth, 0.25f * diagonal(world_bounds(scene))) << name;
  }
}

TEST(FirstView, PrefersTheRoomThatIsLit) {
  const Scene scene = without_cameras("two-rooms-sealed");
  const World world(scene);
  const glm::vec3 eye = eye_of(first_view(world).value().camera);
  const glm::vec3 lamp = scene.lights.at(0).position_ws;
  const glm::vec3 way = lamp - eye;
  EXPECT_FALSE(
      tracer_of(world).occluded({eye, 0.0f, glm::normalize(way), glm::length(way) * 0.999f}));
}

void expect_standing_person(const FirstView& view) {
  EXPECT_TRUE(view.inside);
  EXPECT_NEAR(eye_of(view.camera).y, 1.6f, 0.2f);
}

TEST(FirstView, StandsAtEyeHeightWhereARoomIsOfHumanScale) {
  Scene scene =
      scene_of({box_mesh({-4, 0, -6}, {4, 3, 6}, true), box_mesh({-1, 0, -1}, {1, 1, 1})});
  expect_standing_person(first_view(World(scene)).value());
}

/// Two rows of houses along a street, whose windows, if any, emit `radiance`.
Scene street(float radiance) {
  Scene scene =
      scene_of({box_mesh({-20, -1, -30}, {20, 0, 30}), box_mesh({-16, 0, -30}, {-6, 14, 30}),
                box_mesh({6, 0, -30}, {16, 22, 30})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(radiance)));
  for (int i = 0; i < 40; ++i) {
    const float z = -28.0f + 3.0f * static_cast<float>(i % 20);
    const float y = i < 20 ? 2.0f : 7.0f;
    const bool left = i % 2 == 0;
    test::add(scene, test::quad({left ? -5.98f : 5.98f, y, z}, {0, 1.5f, 0},
                                {0, 0, left ? 1.5f : -1.5f}, 1));
  }
  return scene;
}

// Seen from outside, nothing of it is lit.
TEST(FirstView, StandsInAStreetThatItsWindowsLight) {
  const Scene night = street(8.0f), day = street(0.0f);
  const World world(night);
  const FirstView view = first_view(world).value();
  expect_standing_person(view);
  EXPECT_LT(std::abs(eye_of(view.camera).x), 6.0f);
  EXPECT_EQ(choose_first_light(world, view.camera), FirstLight::scene);
  EXPECT_FALSE(first_view(World(day)).value().inside);
  Scene model = night;
  for (Instance& part : model.instances) part.world_from_object = glm::mat4(glm::mat3(0.2f));
  EXPECT_FALSE(first_view(World(model)).value().inside) << "a model of a street is seen as a thing";
}

TEST(FirstView, StandsInAStreetOfALargeTown) {
  Scene town = scene_of({box_mesh({-150, -1, -150}, {150, 0, 150})});
  town.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(8.0f)));
  for (int i = 0; i < 100; ++i) {
    const glm::vec2 at = 28.0f * glm::vec2(i % 10, i / 10) - 136.0f;
    test::add(town, box_mesh({at.x, 0, at.y}, {at.x + 20, 20, at.y + 20}));
    test::add(town, test::quad({at.x - 0.02f, 2, at.y + 5}, {0, 0, 10}, {0, 1.5f, 0}, 1));
    test::add(town, test::quad({at.x + 5, 2, at.y - 0.02f}, {10, 0, 0}, {0, 1.5f, 0}, 1));
  }
  expect_standing_person(first_view(World(town)).value());
}

TEST(FirstView, StandsInAStreetAndNotOnARoofBetweenTallerHouses) {
  Scene town = scene_of({test::quad({-4, 0, 10}, {8, 0, 0}, {0, 0, -50}, 0)});
  for (int i = 0; i < 5; ++i) {
    const float z = -40.0f + 10.0f * static_cast<float>(i);
    const float height = 8.0f + 2.0f * static_cast<float>(i * 37 % 5);
    test::add(town, box_mesh({-15, 0, z}, {-7, height, z + 10}));
    test::add(town, box_mesh({7, 0, z}, {15, height + 3, z + 10}));
  }
  town.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(15.0f)));
  for (const float z : {0.0f, -8.0f, -15.0f, -24.0f}) {
    test::add(town, test::quad({5.2f, 4, z}, {1.8f, 0, 0}, {0, 0.7f, 0}, 1));
    test::add(town, test::quad({-6.97f, 2.2f, z}, {0, 0, 2}, {0, 0.75f, 0}, 1));
  }
  expect_standing_person(first_view(World(town)).value());
}

TEST(FirstView, StandsInAnAlleyAndNotWithinItsClosedHouses) {
  // Two rows of houses, wall to wall, of surfaces of two sides
  constexpr float kDepth = 22.0f, kEnd = 10.0f;
  std::vector<Mesh> meshes = {
      box_mesh({-4, -0.1f, kEnd - 7 * kDepth}, {4, 0, kEnd}),
      box_mesh({-4, 0, kEnd}, {4, 30, kEnd + 0.1f}),
      box_mesh({-4, 0, kEnd - 7 * kDepth - 0.1f}, {4, 30, kEnd - 7 * kDepth})};
  std::vector<Bounds> houses;
  for (int k = 0; k < 7; ++k) {
    for (const float side : {-1.0f, 1.0f}) {
      const float z = kEnd - kDepth * static_cast<float>(k);
      const float height = 28.0f + static_cast<float>((7 * k + (side > 0.0f ? 5 : 0)) % 15);
      const auto along = [&](float a, float b, float low, float high, float from, float to) {
        return Bounds{{std::min(side * a, side * b), low, from},
                      {std::max(side * a, side * b), high, to}};
      };
      houses.push_back(along(4.0f, 24.0f, 0.0f, height, z - kDepth, z));
      meshes.push_back(box_mesh(houses.back().min, houses.back().max));
    }
  }
  Scene scene = scene_of(std::move(meshes));
  scene.materials[0].double_sided = true;
  const FirstView view = first_view(World(scene)).value();
  for (const Bounds& house : houses) EXPECT_FALSE(holds(house, eye_of(view.camera)));
}

// A window is not what to look at from close by, however far one sees through it.
TEST(FirstView, LooksIntoTheRoomRatherThanOutOfItsWindow) {
  // A shaft with a window in its wall at +X
  std::vector<Mesh> parts;
  parts.push_back(box_mesh({-2, -0.1f, -2}, {2, 0, 2}));
  parts.push_back(box_mesh({-2, 9, -2}, {2, 9.1f, 2}));
  parts.push_back(box_mesh({-2.1f, 0, -2}, {-2, 9, 2}));
  parts.push_back(box_mesh({-2, 0, -2.1f}, {2, 9, -2}));
  parts.push_back(box_mesh({-2, 0, 2}, {2, 9, 2.1f}));
  parts.push_back(box_mesh({2, 0, -2}, {2.1f, 0.8f, 2}));
  parts.push_back(box_mesh({2, 3.2f, -2}, {2.1f, 9, 2}));
  parts.push_back(box_mesh({2, 0.8f, -2}, {2.1f, 3.2f, -1.2f}));
  parts.push_back(box_mesh({2, 0.8f, 1.2f}, {2.1f, 3.2f, 2}));
  parts.push_back(box_mesh({-1.5f, 0, -1.9f}, {0, 0.7f, -1}));
  const Scene scene = scene_of(std::move(parts));
  const World world(scene);
  const FirstView view = first_view(world).value();
  ASSERT_TRUE(view.inside);
  EXPECT_GT(coverage_of(world, view.camera).met, 0.85f);
}

TEST(FirstView, IsTheSameEveryTime) {
  const Scene scene = without_cameras("house");
  EXPECT_EQ(first_view(World(scene)).value().camera.world_from_view,
            first_view(World(scene)).value().camera.world_from_view);
}

TEST(FirstView, ExistsWhereNothingCanBeSeen) {
  const Scene empty;
  EXPECT_GT(first_view(World(empty)).value().camera.vertical_fov, 0.0f);
  // All of a scene in one point
  Scene point = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  for (glm::vec3& position : point.meshes[0].positions) position = {2.0f, 3.0f, 4.0f};
  const glm::vec3 eye = eye_of(first_view(World(point)).value().camera);
  EXPECT_TRUE(std::isfinite(eye.x + eye.y + eye.z));
}

TEST(FirstView, KeepsTheAngleThatIsAskedFor) {
  const Scene scene = scene_of({box_mesh({-1, -1, -1}, {1, 1, 1})});
  EXPECT_EQ(first_view(World(scene), {.vertical_fov = 0.3f}).value().camera.vertical_fov, 0.3f);
}

}  // namespace
}  // namespace lambent::first_view_test
