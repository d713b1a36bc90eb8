// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "lambent/scene.h"

namespace lambent {

/// Cosine and sine of the view's rotation.
glm::vec2 uv_rotation(const TextureView& view);

/// Texture coordinates after the view's transform (KHR_texture_transform), before its wrap modes.
glm::vec2 transform_uv(const TextureView& view, glm::vec2 uv);

/// Filtered texel at texture coordinates `uv` (glTF: (0, 0) is the top left corner), after the
/// view's transform and wrap modes: linear RGBA. `lod` is the MIP level, fractional, clamped to
/// what exists; 0 is full size.
glm::vec4 sample_texture(const Scene& scene, const TextureView& view, glm::vec2 uv,
                         float lod = 0.0f);

/// The one texel of a MIP level (clamped to what exists) at texture coordinates: linear RGBA.
/// Enough where the level was picked so that a texel is as wide as what asks, and four times as
/// fast.
glm::vec4 nearest_texel(const Scene& scene, const TextureView& view, glm::vec2 uv, int level);

}  // namespace lambent
