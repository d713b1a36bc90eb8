// SPDX-License-Identifier: Apache-2.0
// Reading textures, in the common subset of C++ and GLSL. The includer provides the types
//   SceneRef
//   TextureViewRef   how a material reads a texture, with uv_scale and uv_offset
//   TextureLevelRef  a MIP level, with its width and height [texels]
// and
//   uint wrap_u(TextureViewRef view)          kWrapRepeat, ...
//   uint wrap_v(TextureViewRef view)
//   bool is_nearest(TextureViewRef view)      point sampling in place of bilinear
//   vec2 uv_rotation(TextureViewRef view)     cosine and sine
//   int level_count(SceneRef scene, TextureViewRef view)
//   TextureLevelRef fetch_level(SceneRef scene, TextureViewRef view, int level)
//   vec4 fetch_texel(TextureLevelRef level, int x, int y)    linear RGBA

/// Texture coordinates after the view's transform (KHR_texture_transform), before its wrap modes.
LAMBENT_FN vec2 transform_uv(TextureViewRef view, vec2 uv) {
  return transform_uv(uv, view.uv_scale, uv_rotation(view), view.uv_offset);
}

LAMBENT_FN vec2 wrap_uv(TextureViewRef view, vec2 uv) {
  vec2 transformed = transform_uv(view, uv);
  return vec2(wrap_coordinate(transformed.x, wrap_u(view)),
              wrap_coordinate(transformed.y, wrap_v(view)));
}

/// The nearest texel of a MIP level (clamped to the existing ones) at texture coordinates: linear
/// RGBA. Sufficient where the level was chosen so that a texel is as wide as the footprint, and
/// four times as fast as bilinear filtering.
LAMBENT_FN vec4 nearest_texel(SceneRef scene, TextureViewRef view, vec2 uv, int wanted_level) {
  TextureLevelRef level =
      fetch_level(scene, view, clamp(wanted_level, 0, level_count(scene, view) - 1));
  vec2 wrapped = wrap_uv(view, uv);
  return fetch_texel(level, nearest_index(wrapped.x, level.width, wrap_u(view)),
                     nearest_index(wrapped.y, level.height, wrap_v(view)));
}

/// Bilinear interpolation of the four texels whose centres surround a point from wrap_uv(), with
/// weights in float precision.
LAMBENT_FN vec4 bilinear_texel(TextureViewRef view, TextureLevelRef level, vec2 wrapped) {
  TexelPair x = texels_around(wrapped.x, level.width, wrap_u(view));
  TexelPair y = texels_around(wrapped.y, level.height, wrap_v(view));
  return ((1.0f - x.fraction) * (1.0f - y.fraction)) * fetch_texel(level, x.first, y.first) +
         (x.fraction * (1.0f - y.fraction)) * fetch_texel(level, x.second, y.first) +
         ((1.0f - x.fraction) * y.fraction) * fetch_texel(level, x.first, y.second) +
         (x.fraction * y.fraction) * fetch_texel(level, x.second, y.second);
}

/// The texture at full size, nearest or bilinear depending on the view, with weights in float
/// precision.
LAMBENT_FN vec4 filtered_texel(SceneRef scene, TextureViewRef view, vec2 uv) {
  if (is_nearest(view)) return nearest_texel(scene, view, uv, 0);
  return bilinear_texel(view, fetch_level(scene, view, 0), wrap_uv(view, uv));
}

/// The texture at a fractional level from blended_level(), clamped to the existing levels.
/// Trilinear, except for views with point sampling.
LAMBENT_FN vec4 blended_texel(SceneRef scene, TextureViewRef view, vec2 uv, float wanted_level) {
  if (is_nearest(view)) return nearest_texel(scene, view, uv, int(wanted_level + 0.5f));
  float between = min(wanted_level, float(level_count(scene, view) - 1));
  int finer = int(between);
  float share = level_share(between - float(finer));
  vec2 wrapped = wrap_uv(view, uv);
  vec4 texel = bilinear_texel(view, fetch_level(scene, view, finer), wrapped);
  if (share <= 0.0f) return texel;
  return mix(texel, bilinear_texel(view, fetch_level(scene, view, finer + 1), wrapped), share);
}
