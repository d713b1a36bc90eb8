// SPDX-License-Identifier: Apache-2.0
// Ceilings of light panels: a texture that is dark but for rows of bright rectangles.
#pragma once

#include "support/hand_made.h"

namespace lambent::test {

/// Four columns and three rows of panels, which are 28 % of the texture.
inline Texture panel_texture(int size) {
  Texture texture;
  TextureLevel level{size, size, {}};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int across = 4 * x % size, up = 3 * y % size;
      const bool lit =
          6 * across > size && 2 * across < size && 10 * up > size && 18 * up < 17 * size;
      const std::uint8_t byte = lit ? 255 : 0;
      level.rgba.insert(level.rgba.end(), {byte, byte, byte, 255});
    }
  }
  texture.levels.push_back(std::move(level));
  build_mips(texture);
  return texture;
}

/// A grey room of 4 m, about the origin, with such a ceiling: instance 1, material 1, texture 0.
inline Scene panel_room() {
  Scene scene;
  scene.textures = {panel_texture(128)};
  scene.materials = {lambert(glm::vec3(0.5f)), lambert(glm::vec3(0.3f), glm::vec3(5.0f))};
  scene.materials[1].emission_texture.texture = 0;
  add_room(scene, 4.0f, 0);
  scene.meshes[1].material = 1;
  return scene;
}

}  // namespace lambent::test
