// SPDX-License-Identifier: Apache-2.0
// Solid matter is found by what rays meet, whichever way surfaces are wound.
#include "raytracing/solid_sides/solid_sides.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "field/placement/relocate.h"
#include "raytracing/solid_sides/find_solid_sides.h"
#include "raytracing/world_access.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::solid_sides_test {
namespace {

using test::box_mesh;
using test::scene_of;

/// Has the triangles of a mesh run the other way round.
void reverse(Mesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
}

/// A room in walls half a metre thick around a lamp, 5 m wide inside.
Scene thick_walled_room() {
  Scene scene =
      scene_of({box_mesh(vec3(-3.0f), vec3(3.0f)), box_mesh(vec3(-2.5f), vec3(2.5f), true)});
  scene.lights.push_back(test::point_light(vec3(10.0f), vec3(0.2f, 0.1f, 0.3f)));
  return scene;
}

/// Probes in and around it, some of them in the walls.
PlaceGrid around_room() {
  return {vec3(-3.4f), mat3(1.0f), vec3(0.85f), ivec3(9)};
}

SolidSides sides_in(const Scene& scene) {
  const World world(scene);
  const PlaceGrid grid = around_room();
  return find_solid_sides(world, {&grid, 1});
}

/// Whether a point is inside solid matter, by all that its rays meet.
bool is_inside(const Scene& scene, const SolidSides& sides, const vec3& point) {
  const World world(scene);
  std::vector<FixedRayHit> hits(fixed_ray_directions().size());
  const Viewpoint from{point, mat3(1.0f)};
  trace_fixed_rays({scene, tracer_of(world), sides, {}}, {&from, 1}, hits);
  return inside_geometry(hits);
}

void expect_solid_walls(const Scene& scene) {
  const SolidSides sides = sides_in(scene);
  EXPECT_TRUE(is_inside(scene, sides, {0.0f, 2.75f, 0.0f}));
  EXPECT_TRUE(is_inside(scene, sides, {-2.8f, 0.5f, -0.3f}));
  EXPECT_FALSE(is_inside(scene, sides, {0.0f, 2.3f, 0.0f}));
  EXPECT_FALSE(is_inside(scene, sides, {0.0f, 3.2f, 0.0f}));
}

TEST(SolidSides, AreTheInsidesOfWalls) {
  expect_solid_walls(thick_walled_room());
}

TEST(SolidSides, OfASheetRoomAreItsOutsidesHoweverItStands) {
  // A long room of single sheets that is open at one end, under a sky. Of the places in its bounds
  // most are outside if it stands askew
  for (const float degrees : {0.0f, 30.0f, 45.0f, 80.0f}) {
    Mesh room = box_mesh({-10, 0, -3}, {10, 3, 3}, /*inwards=*/true);
    room.triangles.erase(room.triangles.begin(), room.triangles.begin() + 2);
    Scene scene = scene_of({room});
    scene.environment.radiance = vec3(1.0f);
    const glm::mat4 turn =
        glm::rotate(glm::mat4(1.0f), glm::radians(degrees), vec3(0.0f, 1.0f, 0.0f));
    scene.instances[0].world_from_object = turn;
    const World world(scene);
    const PlaceGrid grid = {world_bounds(scene).min, mat3(1.0f), vec3(1.0f), ivec3(16, 4, 16)};
    const SolidSides sides = find_solid_sides(world, {&grid, 1});
    EXPECT_TRUE(is_inside(scene, sides, turn * glm::vec4(0.0f, 1.5f, 3.3f, 1.0f))) << degrees;
    EXPECT_FALSE(is_inside(scene, sides, turn * glm::vec4(5.0f, 1.5f, 0.0f, 1.0f))) << degrees;
  }
}

TEST(SolidSides, AreFoundByALampThatADeepShadeHides) {
  Scene scene =
      scene_of({box_mesh(vec3(-3.0f), vec3(3.0f)), box_mesh(vec3(-2.5f), vec3(2.5f), true)});
  // A shade of 20 cm by 20 cm, 50 cm deep, open below, and a bulb of 3 cm at its top
  const vec3 x(0.2f, 0.0f, 0.0f), y(0.0f, 0.5f, 0.0f), z(0.0f, 0.0f, 0.2f), low(0.1f, 0.6f, 0.3f);
  for (const Mesh& side :
       {test::quad(low, y, x, 0), test::quad(low + z, x, y, 0), test::quad(low, z, y, 0),
        test::quad(low + x, y, z, 0), test::quad(low + y, x, z, 0)}) {
    test::add(scene, side);
  }
  const vec3 bulb = low + 0.5f * (x + z) + 0.9f * y;
  test::add(scene, box_mesh(bulb - 0.015f, bulb + 0.015f));
  scene.meshes.back().material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(test::lambert(vec3(0.0f), vec3(100.0f)));
  expect_solid_walls(scene);
}

TEST(SolidSides, AreTheSameWhicheverWayMeshesAreWound) {
  for (const std::size_t mesh : {0u, 1u}) {
    Scene scene = thick_walled_room();
    reverse(scene.meshes[mesh]);
    expect_solid_walls(scene);
  }
}

TEST(SolidSides, AreTheSameWhereAMeshIsWoundBothWays) {
  Scene scene = thick_walled_room();
  for (Mesh& mesh : scene.meshes) {
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    }
  }
  expect_solid_walls(scene);
}

TEST(SolidSides, DoNotDependOnMaterialsOfTwoSides) {
  Scene scene = thick_walled_room();
  for (Material& material : scene.materials) material.double_sided = true;
  expect_solid_walls(scene);
}

TEST(SolidSides, AreNoneOfASheetInTheOpen) {
  Scene scene;
  scene.materials.push_back(test::lambert(vec3(0.5f)));
  test::add(scene, test::quad({-1.0f, 0.1f, -1.0f}, {0.0f, 0.0f, 2.0f}, {2.0f, 0.0f, 0.0f}, 0));
  const SolidSides sides = sides_in(scene);
  EXPECT_TRUE(std::all_of(sides.words.begin(), sides.words.end(), [](auto w) { return w == 0u; }));
}

/// A tunnel of two-sided sheets, 3 m wide, on piles above a plain under a sky: from its closed end
/// at z = 0 to z = -20, then around a corner and out at x = 20.
Scene bent_tunnel() {
  Scene scene;
  scene.materials.push_back(test::lambert(vec3(0.5f)));
  scene.materials.back().double_sided = true;
  scene.environment.radiance = vec3(1.0f);
  const vec3 x(1, 0, 0), y(0, 2.5f, 0), z(0, 0, 1);
  const auto add = [&](const vec3& corner, const vec3& a, const vec3& b) {
    test::add(scene, test::quad(corner, a, b, 0));
  };
  add({-40, -1, -40}, 80.0f * x, 80.0f * z);
  add({-40, -1, -40}, x, vec3(0, 4, 0));  // a mast, so that the scene ends above the tunnel
  add({0, 0, 0}, 3.0f * x, y);
  add({0, 0, -17}, 17.0f * z, y);
  add({3, 0, -17}, 17.0f * z, y);
  add({0, 0, -20}, 20.0f * x, y);
  add({0, 0, -20}, 3.0f * z, y);
  add({3, 0, -17}, 17.0f * x, y);
  for (const float height : {0.0f, 2.5f}) {
    add({0, height, -17}, 3.0f * x, 17.0f * z);
    add({0, height, -20}, 20.0f * x, 3.0f * z);
  }
  return scene;
}

TEST(OpenPlaces, LeadOutOfOneGridIntoAnother) {
  const Scene scene = bent_tunnel();
  const World world(scene);
  // No ray leaves the tunnel from here, but the places over the whole scene lead on
  const PlaceGrid grid = {vec3(0.3f, 0.3f, -15.5f), mat3(1.0f), vec3(0.8f), ivec3(4, 4, 20)};
  const SolidSides sides = find_solid_sides(world, {&grid, 1});
  // The first two are the scene's own
  ASSERT_EQ(sides.open_space.size(), 3u);
  EXPECT_THAT(sides.open_space[2].open, ::testing::Each(1));
}

TEST(SolidSides, AreThoseOfTheWindingWhereNothingIsSeen) {
  // The second box is far from all probes' sight, inside the walls of the first
  Scene scene = thick_walled_room();
  test::add(scene, box_mesh({2.6f, 0.0f, 0.0f}, {2.7f, 0.1f, 0.1f}));
  const SolidSides sides = sides_in(scene), wound = solid_sides_by_winding(scene);
  ASSERT_TRUE(sides.fits(scene));
  EXPECT_EQ(sides.words[sides.first_word[2]], wound.words[wound.first_word[2]]);
}

TEST(MiswoundMeshes, AreTheSingleSidedOnesThatFaceSolidMatter) {
  Scene scene = thick_walled_room();
  EXPECT_TRUE(miswound_meshes(scene, sides_in(scene)).empty());
  reverse(scene.meshes[1]);
  const std::vector<MiswoundMesh> found = miswound_meshes(scene, sides_in(scene));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].mesh, 1);
  EXPECT_EQ(found[0].triangles, scene.meshes[1].triangles.size());
  // Nothing culls the triangles of two-sided meshes, however they are wound
  for (Material& material : scene.materials) material.double_sided = true;
  EXPECT_TRUE(miswound_meshes(scene, sides_in(scene)).empty());
}

TEST(SolidSides, FitOneSceneOnly) {
  Scene scene = thick_walled_room();
  const SolidSides sides = no_solid_sides(scene);
  EXPECT_TRUE(sides.fits(scene));
  EXPECT_FALSE(SolidSides{}.fits(scene));
  test::add(scene, box_mesh(vec3(5.0f), vec3(6.0f)));
  EXPECT_FALSE(sides.fits(scene));
}

TEST(FieldLight, IsTheSameWhicheverWayMeshesAreWound) {
  FieldSettings settings;
  settings.probe_count = ivec3(7, 6, 7);
  for (const char* name : {"cornell", "two-rooms"}) {
    SCOPED_TRACE(name);
    const test::Stage as_made(scenes::make(name).value());
    Scene reversed = scenes::make(name).value();
    for (std::size_t i = 0; i < reversed.meshes.size(); i += 2) reverse(reversed.meshes[i]);
    const test::Stage wound(std::move(reversed));
    const std::vector<FieldQuery> points = test::seen_points(as_made);
    const std::vector<vec3> expected =
        test::look_up(test::make_field(as_made, settings, 4), points);
    const std::vector<vec3> found = test::look_up(test::make_field(wound, settings, 4), points);
    double difference = 0.0, light = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      difference += length(found[i] - expected[i]);
      light += length(expected[i]);
    }
    EXPECT_LT(difference, 0.01 * light);
  }
}

}  // namespace
}  // namespace lambent::solid_sides_test
