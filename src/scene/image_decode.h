// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "lambent/scene.h"

namespace lambent {

/// Wider or higher images are refused: no texture needs them, and at 4 bytes per texel they would
/// take too much memory.
inline constexpr int kMaxTextureSize = 16384;

/// Decodes PNG, JPEG or WebP to 8-bit RGBA. Errors carry `file` and `place`.
Expected<TextureLevel> decode_image(std::span<const std::uint8_t> bytes, const std::string& file,
                                    const std::string& place);

}  // namespace lambent
