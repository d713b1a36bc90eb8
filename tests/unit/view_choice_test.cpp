// SPDX-License-Identifier: Apache-2.0
// Which of the views of an object or a room a first picture shows.
#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace lambent::view_choice_test
