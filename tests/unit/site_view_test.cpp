// SPDX-License-Identifier: Apache-2.0
// First pictures of gardens, camps, landscapes, and houses in their grounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "first_picture/site.h"
#include "first_picture/survey.h"
#include "lambent/first_picture.h"
#include "raytracing/trace_rays.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::site_view_test {
namespace {

using test::box_mesh;

constexpr float kEyeAboveGround = 1.6f;

glm::vec3 eye_of(const Camera& camera) {
  return glm::vec3(camera.world_from_view[3]);
}

/// A sheet of ground, 60 m wide.
Scene wide_ground() {
  return test::scene_of({test::quad({-30, 0, 30}, {60, 0, 0}, {0, 0, -60}, 0)});
}

/// Adds trees of one mesh, by a lattice of places 8 m apart.
void add_trees(Scene& scene, float height) {
  test::add(scene, box_mesh({-0.4f, 0, -0.4f}, {0.4f, height, 0.4f}));
  const int mesh = scene.instances.back().mesh;
  scene.instances.pop_back();
  for (int i = 0; i < 49; ++i) {
    if (i == 24) continue;
    Instance tree;
    tree.mesh = mesh;
    tree.world_from_object[3] = {8.0f * static_cast<float>(i % 7 - 3), 0.0f,
                                 8.0f * static_cast<float>(i / 7 - 3), 1.0f};
    scene.instances.push_back(tree);
  }
}

/// Adds a camp of different things in the middle. Returns the number of instances before.
std::size_t add_camp(Scene& scene) {
  const std::size_t before = scene.instances.size();
  for (int i = 0; i < 6; ++i) {
    const float x = 0.9f * static_cast<float>(i) - 2.5f, z = static_cast<float>(i % 2);
    test::add(scene,
              box_mesh({x, 0, z}, {x + 0.6f, 0.7f + 0.1f * static_cast<float>(i), z + 0.5f}));
  }
  return before;
}

/// How many of the instances from `first` on a camera sees.
std::size_t count_seen(const World& world, const Camera& camera, std::size_t first) {
  std::vector<bool> seen(world.scene().instances.size());
  for (const Hit& hit : trace(world, frame_rays(camera, 16.0f / 9.0f, 128, 72))) {
    if (!hit.missed()) seen[hit.instance] = true;
  }
  return static_cast<std::size_t>(
      std::count(seen.begin() + static_cast<std::ptrdiff_t>(first), seen.end(), true));
}

TEST(SiteView, StandsOnTheGroundBeforeWhatIsOfManyKinds) {
  Scene scene = wide_ground();
  add_trees(scene, 6.0f);
  const std::size_t camp = add_camp(scene);
  const World world(scene);
  const FirstView view = first_view(world).value();
  EXPECT_TRUE(view.inside);
  EXPECT_NEAR(eye_of(view.camera).y, kEyeAboveGround, 1e-3f);
  EXPECT_GE(count_seen(world, view.camera, camp), 4u);
  EXPECT_EQ(choose_first_light(world, view.camera), FirstLight::sun);
}

TEST(SiteView, TakesAWoodInWhichEachTreeIsAMeshForOneKind) {
  Scene scene = wide_ground();
  for (int i = 0; i < 49; ++i) {
    if (i == 24) continue;
    const glm::vec3 at(8.0f * static_cast<float>(i % 7 - 3), 0.0f,
                       8.0f * static_cast<float>(i / 7 - 3));
    test::add(scene, box_mesh(at - glm::vec3(0.4f, 0, 0.4f),
                              at + glm::vec3(0.4f, 5.0f + 0.05f * static_cast<float>(i), 0.4f)));
  }
  const std::size_t camp = add_camp(scene);
  const World world(scene);
  EXPECT_GE(count_seen(world, first_view(world).value().camera, camp), 4u);
}

TEST(SiteView, OfThingsThatAreThinIsInTheOpen) {
  // Posts on a lawn, between the rays that look down onto it
  Scene scene = test::scene_of({test::quad({-8, 0, 8}, {16, 0, 0}, {0, 0, -16}, 0)});
  for (int i = 0; i < 9; ++i) {
    const glm::vec3 at(5.0f * static_cast<float>(i % 3 - 1), 0.0f,
                       5.0f * static_cast<float>(i / 3 - 1));
    test::add(scene, box_mesh(at - glm::vec3(0.2f, 0, 0.2f), at + glm::vec3(0.2f, 2.6f, 0.2f)));
  }
  const World world(scene);
  const FirstView view = first_view(world).value();
  EXPECT_TRUE(view.inside);
  EXPECT_EQ(choose_first_light(world, view.camera), FirstLight::sun);
}

TEST(SiteView, IsNotOfModelsAndCircuitBoards) {
  // The same, a tenth as large
  Scene model = wide_ground();
  add_trees(model, 6.0f);
  add_camp(model);
  for (Instance& part : model.instances) {
    part.world_from_object = glm::mat4(glm::mat3(0.1f)) * part.world_from_object;
  }
  EXPECT_FALSE(first_view(World(model)).value().inside);
  // A board has an underside, and what a lamp lights is no board; suns are exported with anything
  Scene board = test::scene_of({box_mesh({-30, -1, -30}, {30, 0, 30})});
  add_trees(board, 6.0f);
  board.lights.push_back(test::sun(glm::vec3(5.0f), {0, -1, 0}));
  EXPECT_FALSE(first_view(World(board)).value().inside);
  board.lights.push_back(test::point_light(glm::vec3(100.0f), {1, 4, 1}));
  EXPECT_TRUE(first_view(World(board)).value().inside);
}

TEST(SiteView, IsNotOfATownThatHidesItsGround) {
  Scene town = wide_ground();
  add_trees(town, 6.0f);
  ASSERT_TRUE(first_view(World(town)).value().inside) << "trees do not";
  for (Instance& house : town.instances) {
    if (house.mesh != 0) house.world_from_object[0][0] = house.world_from_object[2][2] = 8.0f;
  }
  EXPECT_FALSE(first_view(World(town)).value().inside);
}

// What is wide and thin is no ground if something is below it.
TEST(SiteView, TakesNoCrownsThatAreOneMeshForAGround) {
  Scene scene = wide_ground();
  scene.lights.push_back(test::point_light(glm::vec3(100.0f), {1, 4, 1}));
  add_camp(scene);
  Mesh crowns;
  for (int i = 0; i < 49; ++i) {
    const glm::vec3 low(8.0f * static_cast<float>(i % 7 - 3) - 2.5f, 6.0f,
                        8.0f * static_cast<float>(i / 7 - 3) - 2.5f);
    const Mesh crown = box_mesh(low, low + glm::vec3(5, 3, 5));
    const auto first = static_cast<std::uint32_t>(crowns.positions.size());
    crowns.positions.insert(crowns.positions.end(), crown.positions.begin(), crown.positions.end());
    crowns.normals.insert(crowns.normals.end(), crown.normals.begin(), crown.normals.end());
    for (const glm::uvec3& t : crown.triangles) crowns.triangles.push_back(t + first);
  }
  test::add(scene, std::move(crowns));
  const World world(scene);
  const auto site = find_site(world, find_subject(world));
  ASSERT_TRUE(site.has_value());
  EXPECT_TRUE(site->is_ground.front());
  EXPECT_FALSE(site->is_ground.back());
}

TEST(SiteView, IsNotOfAModelOnItsPlinth) {
  Scene model = wide_ground();
  add_trees(model, 6.0f);
  test::add(model, box_mesh({-30, -4, -30}, {30, -0.5f, 30}));
  EXPECT_FALSE(first_view(World(model)).value().inside);
}

TEST(SiteView, IsNotOfAThingThatItsGroundDwarfs) {
  const Scene scene = test::scene_of(
      {test::quad({-200, 0, 200}, {400, 0, 0}, {0, 0, -400}, 0), box_mesh({-15, 1, -2}, {15, 4, 2}),
       box_mesh({-3, 2, -14}, {3, 2.5f, 14}), box_mesh({12, 4, -0.5f}, {15, 9, 0.5f})});
  EXPECT_FALSE(first_view(World(scene)).value().inside);
}

/// Adds a hall of 8 by 6 by 3 m with an open door, and boxes inside.
void add_furnished_house(Scene& scene, bool roof) {
  const Bounds walls[] = {{{-4, 0, -3}, {4, 3, -2.8f}}, {{-4, 0, -3}, {-3.8f, 3, 3}},
                          {{3.8f, 0, -3}, {4, 3, 3}},   {{-4, 0, 2.8f}, {1, 3, 3}},
                          {{2, 0, 2.8f}, {4, 3, 3}},    {{-4, 3, -3}, {4, 3.2f, 3}},
                          {{-4, 0, -3}, {4, 0.02f, 3}}};
  for (const Bounds& wall : walls) {
    if (roof || wall.min.y < 3.0f) test::add(scene, box_mesh(wall.min, wall.max));
  }
  for (int i = 0; i < 12; ++i) {
    const float x = 0.25f * static_cast<float>(i) - 3.5f;
    test::add(scene, box_mesh({x, 1.0f, -2.7f}, {x + 0.15f, 1.3f, -2.5f}));
  }
}

TEST(SiteView, IsInTheFurnishedHouse) {
  Scene scene = wide_ground();
  add_trees(scene, 6.0f);
  add_furnished_house(scene, /*roof=*/true);
  const FirstView view = first_view(World(scene)).value();
  EXPECT_TRUE(view.inside);
  const glm::vec3 eye = eye_of(view.camera);
  EXPECT_LT(std::abs(eye.x), 4.0f);
  EXPECT_LT(std::abs(eye.z), 3.0f);
  EXPECT_LT(eye.y, 3.0f);
}

TEST(SiteView, IsNotInARuin) {
  Scene scene = wide_ground();
  add_trees(scene, 6.0f);
  add_furnished_house(scene, /*roof=*/false);
  const glm::vec3 eye = eye_of(first_view(World(scene)).value().camera);
  EXPECT_TRUE(std::abs(eye.x) > 4.0f || std::abs(eye.z) > 3.0f) << eye.x << ", " << eye.z;
}

/// A valley 80 m wide, with hills of 15 m around a middle that is flat.
Mesh valley() {
  constexpr int kCells = 40;
  Mesh mesh;
  for (int i = 0; i < (kCells + 1) * (kCells + 1); ++i) {
    const glm::vec2 at = 2.0f * glm::vec2(i % (kCells + 1), i / (kCells + 1)) - 40.0f;
    mesh.positions.push_back({at.x, std::clamp(glm::length(at) - 15.0f, 0.0f, 15.0f), at.y});
    mesh.normals.push_back({0, 1, 0});
  }
  for (int i = 0; i < kCells * kCells; ++i) {
    const auto a = static_cast<std::uint32_t>(i / kCells * (kCells + 1) + i % kCells);
    const std::uint32_t b = a + kCells + 1;
    mesh.triangles.push_back({a, b, a + 1});
    mesh.triangles.push_back({a + 1, b, b + 1});
  }
  return mesh;
}

TEST(SiteView, StandsInTheValleyAmongHills) {
  Scene scene = test::scene_of({valley()});
  add_trees(scene, 16.0f);
  const std::size_t hut = scene.instances.size();
  add_camp(scene);
  test::add(scene, box_mesh({-3, 0, 2}, {3, 2.5f, 6}));
  test::add(scene, box_mesh({-3.2f, 2.5f, 1.8f}, {3.2f, 4, 6.2f}));
  const World world(scene);
  const FirstView view = first_view(world).value();
  EXPECT_TRUE(view.inside);
  EXPECT_NEAR(eye_of(view.camera).y, kEyeAboveGround, 1e-3f);
  EXPECT_GE(count_seen(world, view.camera, hut), 5u);
}

TEST(FirstView, OfAChurchStandsOnTheFloorAndNotOnAPew) {
  Scene scene = test::scene_of({box_mesh({-5, 0, -12}, {5, 8, 12}, true)});
  for (int row = 0; row < 14; ++row) {
    for (const float side : {-1.0f, 1.0f}) {
      const float z = 1.4f * static_cast<float>(row) - 9.0f;
      const float from = std::min(side * 0.8f, side * 4.8f),
                  to = std::max(side * 0.8f, side * 4.8f);
      test::add(scene, box_mesh({from, 0, z}, {to, 0.45f, z + 0.9f}));
    }
  }
  EXPECT_NEAR(eye_of(first_view(World(scene)).value().camera).y, kEyeAboveGround, 1e-3f);
}

}  // namespace
}  // namespace lambent::site_view_test
