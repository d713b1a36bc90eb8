// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "lambent/scene.h"

namespace lambent {

/// Wider or higher images are refused: no texture of a scene needs them, and 4 bytes a texel add
/// up.
inline constexpr int kMaxTextureSize = 16384;

/// Decodes PNG, JPEG or WebP to 8-bit RGBA. Errors carry `file` and `place`.
Expected<TextureLevel> decode_image(std::span<const std::uint8_t> bytes, const std::string& file,
                                    const std::string& place);

}  // namespace lambent
