// SPDX-License-Identifier: Apache-2.0
// Which of the views of an object or a room a first picture shows.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "first_picture/survey.h"
#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::view_choice_test {
namespace {

// A camera hardly above a laid table or the face of a watch shows next to nothing of it.
TEST(FirstView, LooksDownFartherOnFlatThings) {
  const auto elevation = [](float height) {
    const Scene scene = test::scene_of({test::box_mesh({-1, 0, -1}, {1, height, 1})});
    const Camera camera = first_view(World(scene), {}).value().camera;
    return std::asin(camera.world_from_view[2].y);
  };
  EXPECT_GT(elevation(0.2f), glm::radians(30.0f));
  EXPECT_LT(elevation(2.0f), glm::radians(20.0f));
}

// A hall is dark but for twelve spots, all on the thing at one end; the other end has more details.
TEST(FirstView, FacesTheOnlyThingThatIsLit) {
  for (const float side : {-1.0f, 1.0f}) {
    Scene scene;
    scene.materials = {test::lambert(glm::vec3(0.5f))};
    test::add(scene, test::box_mesh({-6, 0, -14}, {6, 6, 14}, true));
    for (int row = 0; row < 8; ++row) {
      for (int seat = 0; seat < 8; ++seat) {
        const glm::vec3 at(-4.2f + 1.2f * static_cast<float>(seat), 0,
                           -side * (2.0f + 1.2f * static_cast<float>(row)));
        test::add(scene, test::box_mesh(at, at + glm::vec3(0.5f, 0.9f, 0.5f)));
        const glm::vec3 on_wall(at.x, 0.6f * static_cast<float>(row + 1), -13.8f * side);
        test::add(scene, test::box_mesh(on_wall, on_wall + glm::vec3(0.6f, 0.3f, 0.1f)));
      }
    }
    const glm::vec3 thing(0.0f, 0.0f, 9.0f * side);
    test::add(scene, test::box_mesh(thing, thing + glm::vec3(0.6f, 1.8f, 0.4f)));
    for (int i = 0; i < 12; ++i) {
      Light& spot = scene.lights.emplace_back();
      spot.type = Light::Type::spot;
      spot.position_ws = thing + glm::vec3(static_cast<float>(i) - 5.5f, 5.8f, -2.0f * side);
      spot.direction_ws = glm::normalize(thing - spot.position_ws);
      spot.intensity = glm::vec3(200.0f);
      spot.inner_cone_angle = 0.1f;
      spot.outer_cone_angle = 0.2f;
    }
    const FirstView view = first_view(World(scene), {}).value();
    EXPECT_TRUE(view.inside);
    const glm::vec3 eye(view.camera.world_from_view[3]);
    const glm::vec3 ahead = -glm::vec3(view.camera.world_from_view[2]);
    EXPECT_GT(glm::dot(ahead, glm::normalize(thing + glm::vec3(0, 1, 0) - eye)), 0.8f) << side;
  }
}

/// A case without a lid, 1 high, 1.6 wide and 1 deep, with parts within, scaled.
Scene open_case(float scale) {
  const auto box = [&](const glm::vec3& min, const glm::vec3& max) {
    return test::box_mesh(scale * min, scale * max);
  };
  return test::scene_of({box({0, -0.1f, 0}, {1.6f, 0, 1}), box({-0.1f, -0.1f, 0}, {0, 1, 1}),
                         box({1.6f, -0.1f, 0}, {1.7f, 1, 1}), box({0, 0, -0.1f}, {1.6f, 1, 0}),
                         box({0, 0, 1}, {1.6f, 1, 1.1f}), box({0.3f, 0, 0.3f}, {0.5f, 0.3f, 0.6f}),
                         box({1.0f, 0, 0.4f}, {1.3f, 0.2f, 0.7f})});
}

TEST(FirstView, LooksIntoACaseWithoutALidFromAbove) {
  for (const float scale : {0.2f, 40.0f, 150.0f}) {  // in metres, or in millimetres
    const Scene scene = open_case(scale);
    const World world(scene);
    const FirstView view = first_view(world).value();
    EXPECT_FALSE(view.inside) << scale;
    EXPECT_GT(view.camera.world_from_view[2].y, std::sin(glm::radians(30.0f))) << scale;
    EXPECT_EQ(choose_first_light(world, view.camera), FirstLight::studio) << scale;
  }
  const Scene flat = open_case(2.7f);
  EXPECT_TRUE(first_view(World(flat)).value().inside) << "a flat without its ceiling";
}

// A panel of unlit colour tells nothing of how bright lamps are.
TEST(FirstLight, IsWhatASoftBoxSendsBesideAnUnlitPanel) {
  Scene scene = test::scene_of({test::box_mesh({-0.2f, 0, -0.2f}, {0.2f, 0.5f, 0.2f})});
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(1.5f)));
  scene.materials.push_back(test::lambert(glm::vec3(0.3f)));
  scene.materials.back().unlit = true;
  test::add(scene, test::quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0));
  test::add(scene, test::quad({-0.9f, 0.9f, 0.9f}, {0.3f, 0, 0.3f}, {0.1f, 0.4f, -0.1f}, 1));
  test::add(scene, test::quad({-1, 0.6f, -1}, {2, 0, 0}, {0, 0.6f, 0}, 2));
  const Camera camera = look_at({0, 1, 3}, {0, 0.4f, 0}, 0.8f);
  EXPECT_EQ(choose_first_light(World(scene), camera), FirstLight::scene);
}

// Slopes all around a valley enclose its air, but it is no housing.
TEST(FirstView, ShowsAValleyByDay) {
  Mesh valley;
  for (const auto& [half, y] : {std::pair(60.0f, 0.0f), std::pair(100.0f, 60.0f)}) {
    for (const glm::vec2& corner : {glm::vec2(-1, -1), {-1, 1}, {1, 1}, {1, -1}}) {
      valley.positions.emplace_back(half * corner.x, y, half * corner.y);
      valley.normals.emplace_back(0.0f, 1.0f, 0.0f);
    }
  }
  valley.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned next = (i + 1) % 4;
    valley.triangles.insert(valley.triangles.end(), {{i, i + 4, next + 4}, {i, next + 4, next}});
  }
  const Scene scene = test::scene_of({valley});
  const World world(scene);
  ASSERT_GE(survey_space(world, world_bounds(scene)).enclosed_share, 0.25f);
  EXPECT_EQ(choose_first_light(world, first_view(world).value().camera), FirstLight::sun);
}

/// A nave without its ceiling, 14 x 32 x 11 m, as somebody scanned it from within: walls that are
/// sheets, those along the sides with their fronts outwards, as scanners do not know; with windows
/// every 4 m, rows of columns and pews. All of it is one mesh.
Scene roofless_nave() {
  Scene scene = test::scene_of({test::quad({-7, 0, 16}, {14, 0, 0}, {0, 0, -32}, 0)});
  const auto wall = [&](const glm::vec3& origin, const glm::vec3& along, float low, float high) {
    const glm::vec3 foot = origin + glm::vec3(0, low, 0), up(0, high - low, 0);
    test::add(scene, test::quad(foot, along, up, 0));
  };
  wall({-7, 0, -16}, {14, 0, 0}, 0, 13);
  wall({7, 0, 16}, {-14, 0, 0}, 0, 11);
  for (int bay = -4; bay < 4; ++bay) {
    const float z = 4.0f * static_cast<float>(bay);
    for (const float side : {-1.0f, 1.0f}) {
      const float start = side < 0.0f ? z : z + 4.0f, way = -side;
      wall({7 * side, 0, start}, {0, 0, 2.6f * way}, 0, 11);
      wall({7 * side, 0, start + 2.6f * way}, {0, 0, 1.4f * way}, 0, 3.2f);
      wall({7 * side, 0, start + 2.6f * way}, {0, 0, 1.4f * way}, 8.2f, 11);
      const glm::vec3 column(3.6f * side, 0, z + 2);
      test::add(scene, test::box_mesh(column - glm::vec3(0.35f, 0, 0.35f),
                                      column + glm::vec3(0.35f, 6.8f, 0.35f)));
      const glm::vec3 pew(1.6f * side, 0, 0.7f * z + 3);
      test::add(scene,
                test::box_mesh(pew - glm::vec3(1.2f, 0, 0.2f), pew + glm::vec3(1.2f, 0.9f, 0.2f)));
    }
  }
  Mesh joined;
  for (const Mesh& part : scene.meshes) {
    const auto first = static_cast<std::uint32_t>(joined.positions.size());
    joined.positions.insert(joined.positions.end(), part.positions.begin(), part.positions.end());
    joined.normals.insert(joined.normals.end(), part.normals.begin(), part.normals.end());
    for (const glm::uvec3& t : part.triangles) joined.triangles.push_back(t + first);
  }
  return test::scene_of({std::move(joined)});
}

TEST(FirstView, StandsInAChurchThatHasLostItsCeiling) {
  const Scene scene = roofless_nave();
  const World world(scene);
  const FirstView view = first_view(world).value();
  ASSERT_TRUE(view.inside);
  const glm::vec3 eye(view.camera.world_from_view[3]);
  EXPECT_NEAR(eye.y, 1.6f, 0.05f);
  EXPECT_GT(std::abs(view.camera.world_from_view[2].z), 0.7f) << "along the nave";
  EXPECT_EQ(choose_first_light(world, view.camera), FirstLight::sun);
}

/// A car with panes all around, scaled.
Scene car(float scale) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f)), Material{}};
  scene.materials[1].metallic = 0.0f;
  scene.materials[1].roughness = 0.0f;
  scene.materials[1].transmission = 1.0f;
  const auto add = [&](const glm::vec3& min, const glm::vec3& max, int material = 0) {
    Mesh box = test::box_mesh(scale * min, scale * max);
    box.material = material;
    test::add(scene, std::move(box));
  };
  add({-0.9f, 0.3f, -2}, {0.9f, 0.4f, 2});    // floor
  add({-0.9f, 0.3f, -2}, {-0.85f, 0.9f, 2});  // doors
  add({0.85f, 0.3f, -2}, {0.9f, 0.9f, 2});
  add({-0.9f, 0.3f, -2.05f}, {0.9f, 0.9f, -2});    // tail
  add({-0.9f, 0.3f, 1}, {0.9f, 0.9f, 2.2f});       // bonnet
  add({-0.8f, 1.4f, -1.8f}, {0.8f, 1.45f, 0.8f});  // roof
  add({-0.6f, 0.4f, -1}, {0.6f, 0.7f, -0.5f});     // seats
  add({-0.6f, 0.7f, -1.1f}, {0.6f, 1.1f, -1});
  add({-0.85f, 0.9f, -1.9f}, {-0.84f, 1.4f, 1}, 1);  // panes
  add({0.84f, 0.9f, -1.9f}, {0.85f, 1.4f, 1}, 1);
  add({-0.85f, 0.9f, 1}, {0.85f, 1.4f, 1.01f}, 1);
  add({-0.85f, 0.9f, -1.9f}, {0.85f, 1.4f, -1.89f}, 1);
  for (const float x : {-0.9f, 0.7f}) {
    for (const float z : {-1.6f, 1.2f}) add({x, 0, z}, {x + 0.2f, 0.6f, z + 0.6f});
  }
  return scene;
}

// The cabin of a car is enclosed, but no room: more of the car is seen from outside.
TEST(FirstView, ShowsACarFromOutside) {
  for (const float scale : {1.0f, 1000.0f}) {
    const Scene scene = car(scale);
    const World world(scene);
    ASSERT_GE(survey_space(world, world_bounds(scene)).enclosed_share, 0.25f);
    EXPECT_FALSE(first_view(world).value().inside) << scale;
  }
}

}  // namespace
}  // namespace lambent::view_choice_test
