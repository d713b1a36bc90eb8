// SPDX-License-Identifier: Apache-2.0
// Procedural textures: seamless, the same bits every time. Every pattern is a function of a point
// of the unit square that repeats with period 1; lengths below are shares of the tile.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>

#include "lambent/scene.h"

namespace lambent::scenes {

/// The values of a pattern at one point.
struct Texel {
  glm::vec3 color{0.5f};   ///< Linear reflectance, 0 to 1.
  float height = 0.0f;     ///< Relief [m].
  float roughness = 0.8f;  ///< Perceptual, 0 to 1.
};

using Pattern = std::function<Texel(glm::vec2)>;

/// Textures of one surface. Each is complete with MIPs.
struct TextureSet {
  Texture color;      ///< sRGB.
  Texture normal;     ///< Tangent space, from the relief.
  Texture roughness;  ///< G roughness; B metallic, 0.
};

/// Evaluates a pattern at size x size texels; `metres_a_tile` scales the relief's slopes.
TextureSet bake(const std::string& name, int size, float metres_a_tile, const Pattern& pattern);

/// Ashlar of warm sandstone in running bond, four courses a tile.
Texel sandstone_blocks(glm::vec2 p);
/// Pale dressed stone without joints, for columns and mouldings.
Texel limestone(glm::vec2 p);
/// Polished squares, cream and rust, with veins: four a side.
Texel marble_checker(glm::vec2 p);
/// Worn flags of three widths for the open court.
Texel flagstones(glm::vec2 p);
/// Lime plaster in ochre with trowel marks.
Texel plaster(glm::vec2 p);
/// Planks along v, six a tile.
Texel wood_planks(glm::vec2 p);
/// Fired clay with pale bloom.
Texel terracotta(glm::vec2 p);
/// Plain weave with stripes along the threads of the warp.
Texel woven_fabric(glm::vec2 p, const glm::vec3& ground, const glm::vec3& stripe);

}  // namespace lambent::scenes
