// SPDX-License-Identifier: Apache-2.0
// A floor under lamps of two colours.
#pragma once

#include "lambent/scene.h"
#include "support/hand_made.h"

namespace lambent::test {

const glm::vec3 kPink(12.0f, 1.0f, 5.0f), kBlue(0.5f, 3.0f, 16.0f);  // [W/(m^2 sr)]

/// A white floor under a pink and a blue lamp, seen from above them.
inline Scene two_lamps() {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.8f)), lambert(glm::vec3(0.0f), kPink),
                     lambert(glm::vec3(0.0f), kBlue)};
  const glm::vec3 along(1.0f, 0.0f, 0.0f), across(0.0f, 0.0f, 1.0f);
  add(scene, quad(-2.0f * (along + across), 4.0f * across, 4.0f * along, 0));
  for (int lamp = 1; lamp <= 2; ++lamp) {
    const glm::vec3 corner(lamp == 1 ? -1.0f : 0.9f, 0.3f, -0.5f);
    add(scene, quad(corner, 0.1f * along, across, lamp));
  }
  scene.cameras = {look_at({0.0f, 5.0f, 0.0f}, glm::vec3(0.0f), 0.8f)};
  return scene;
}

}  // namespace lambent::test
