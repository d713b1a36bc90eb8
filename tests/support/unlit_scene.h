// SPDX-License-Identifier: Apache-2.0
// A floor under a lamp, and a sign that is to be seen in its own colour.
#pragma once

#include "lambent/scene.h"
#include "shared/constants.h"
#include "support/hand_made.h"

namespace lambent::test {

/// Where the sign is in the middle row of the scene's picture, and where the floor beside it is.
inline constexpr float kSignX = 0.25f, kFloorX = 0.75f;

/// The sign is on the left, the floor fills the rest. The lamp's light does not fall on the sign
/// alone: it would not be seen in it.
inline Scene scene_with_sign(const glm::vec3& color, float lamp_intensity) {
  Scene scene;
  Material sign;
  sign.name = "sign";
  sign.unlit = true;
  sign.base_color = glm::vec4(color, 1.0f);
  scene.materials = {lambert(glm::vec3(0.5f)), sign};
  add(scene, quad({-5.0f, 0.0f, 5.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -10.0f}, 0));
  add(scene, quad({-2.0f, 1.0f, 1.0f}, {1.9f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f}, 1));
  Light lamp;
  lamp.intensity = glm::vec3(lamp_intensity);
  lamp.position_ws = {1.0f, 4.0f, 0.0f};
  scene.lights = {lamp};
  scene.cameras = {look_at({0.0f, 3.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 0.25f * kPi)};
  return scene;
}

}  // namespace lambent::test
