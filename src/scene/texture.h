// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/byte_decoding.h"
#include "lambent/scene.h"
#include "scene/mip_level.h"
#include "scene/texture_lookup.h"

namespace lambent {

static_assert(kWrapRepeat == static_cast<uint>(Wrap::repeat) &&
              kWrapMirroredRepeat == static_cast<uint>(Wrap::mirrored_repeat) &&
              kWrapClampToEdge == static_cast<uint>(Wrap::clamp_to_edge));

/// Throws std::invalid_argument where a texture's first level does not have all of its texels.
void check_first_level(const Texture& texture);

/// A MIP level, and the tables that decode its bytes to linear values.
struct DecodedLevel {
  const std::uint8_t* rgba;
  int width;   ///< [texels]
  int height;  ///< [texels]
  const float* color;
  const float* alpha;
};

// The types and functions that texture.inl.h requires.
using SceneRef = const Scene&;
using TextureViewRef = const TextureView&;
using TextureLevelRef = DecodedLevel;

inline uint wrap_u(const TextureView& view) {
  return static_cast<uint>(view.wrap_u);
}
inline uint wrap_v(const TextureView& view) {
  return static_cast<uint>(view.wrap_v);
}
inline bool is_nearest(const TextureView& view) {
  return view.nearest;
}
inline vec2 uv_rotation(const TextureView& view) {
  if (view.uv_rotation == 0.0f) return {1.0f, 0.0f};
  return {std::cos(view.uv_rotation), std::sin(view.uv_rotation)};
}
inline int level_count(const Scene& scene, const TextureView& view) {
  return static_cast<int>(scene.textures[view.texture].levels.size());
}
inline DecodedLevel fetch_level(const Scene& scene, const TextureView& view, int index) {
  const Texture& texture = scene.textures[view.texture];
  const TextureLevel& level = texture.levels[index];
  const float* const linear = linear_byte_decoding().data();
  return {level.rgba.data(), level.width, level.height,
          texture.srgb ? srgb_byte_decoding().data() : linear, linear};
}
inline vec4 fetch_texel(const DecodedLevel& level, int x, int y) {
  const std::uint8_t* p = level.rgba + (static_cast<std::size_t>(y) * level.width + x) * 4;
  return {level.color[p[0]], level.color[p[1]], level.color[p[2]], level.alpha[p[3]]};
}

#include "scene/texture.inl.h"

/// Samples a texture through a view, at a MIP level; 0: at full size.
inline vec4 sample_texture(const Scene& scene, const TextureView& view, vec2 uv,
                           float level = 0.0f) {
  return blended_texel(scene, view, uv, level);
}

/// The views of a Material or const Material, as pointers to these.
template <class AMaterial>
auto texture_views(AMaterial& m) {
  return std::array{&m.base_color_texture,
                    &m.metallic_roughness_texture,
                    &m.normal_texture,
                    &m.emission_texture,
                    &m.specular_texture,
                    &m.specular_color_texture,
                    &m.transmission_texture,
                    &m.clearcoat_texture,
                    &m.clearcoat_roughness_texture,
                    &m.clearcoat_normal_texture,
                    &m.sheen_color_texture,
                    &m.sheen_roughness_texture,
                    &m.iridescence_texture,
                    &m.iridescence_thickness_texture};
}

/// Whether `view` belongs to the material's sheen or clearcoat.
inline bool is_of_layers(const Material& m, const TextureView* view) {
  return view == &m.clearcoat_texture || view == &m.clearcoat_roughness_texture ||
         view == &m.clearcoat_normal_texture || view == &m.sheen_color_texture ||
         view == &m.sheen_roughness_texture;
}

/// Whether `view` belongs to the material's thin film.
inline bool is_of_film(const Material& m, const TextureView* view) {
  return view == &m.iridescence_texture || view == &m.iridescence_thickness_texture;
}

}  // namespace lambent
