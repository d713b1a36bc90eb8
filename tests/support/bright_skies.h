// SPDX-License-Identifier: Apache-2.0
// Skies with small parts that are much brighter than the rest.
#pragma once

#include "lambent/scene.h"

namespace lambent::test {

/// Red, green and blue fields on a dim sky; the green ones are its bright part.
inline Environment checkered_sky() {
  Environment sky;
  sky.radiance = {1.0f, 0.5f, 2.0f};
  sky.map = Image(360, 180, 3);
  for (int y = 0; y < 180; ++y) {
    for (int x = 0; x < 360; ++x) {
      for (int k = 0; k < 3; ++k) {
        sky.map.at(x, y)[k] = (x / 20 + y / 30) % 4 == k ? 8.0f : 0.25f;
      }
    }
  }
  return sky;
}

/// A dim sky with a sun of almost 3 degrees, which sends as much light as all the rest.
inline Environment sunny_sky() {
  Environment sky;
  sky.radiance = glm::vec3(1.0f);
  sky.map = Image(256, 128, 3);
  for (float& value : sky.map.pixels) value = 0.5f;
  for (int y = 40; y < 42; ++y) {
    for (int x = 150; x < 152; ++x) {
      for (int k = 0; k < 3; ++k) sky.map.at(x, y)[k] = 4000.0f;
    }
  }
  sky.rotation = 0.7f;
  return sky;
}

}  // namespace lambent::test
