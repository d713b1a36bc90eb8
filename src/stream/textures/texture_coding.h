// SPDX-License-Identifier: Apache-2.0
// Light through a video codec: bodies of texture messages, and the state that results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "stream/light/light_state.h"
#include "stream/light/tile_basis.h"
#include "stream/textures/texture_atlas.h"

namespace lambent::stream {

/// Maximum number of pictures in an update.
inline constexpr int kMaxTexturePictures = 8;

/// Units of a state per texture's scale: finer than the picture's steps of 1 / 1023.
inline constexpr float kTextureUnits = 4096.0f;

/// The pictures of an update, one refining the other.
struct TextureBody {
  float scale = 1.0f;  ///< [(W/m^2)^(1/2)], kLeastUnit * kTextureUnits to kMaxUnit.
  std::vector<std::span<const std::byte>> pictures;
};
std::vector<std::byte> write_texture(float scale, std::span<const std::vector<std::byte>> pictures);
/// Reads a body, to which the result refers. Fails on data that no encoder wrote.
Expected<TextureBody> read_texture(std::span<const std::byte> body);

/// The state of light in a picture, without its update.
LightState state_of(const TextureAtlas& atlas, const LightLayout& layout, const TileBasis& basis,
                    const TexturePicture& shown, float scale);

}  // namespace lambent::stream
