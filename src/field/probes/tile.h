// SPDX-License-Identifier: Apache-2.0
// A probe's octahedral tile: `texels` x `texels` directions, with a gutter of one texel on all
// sides. The gutter repeats the texels across the octahedron's fold, so that a bilinear fetch never
// leaves the tile.
#ifndef LAMBENT_FIELD_PROBES_TILE_H
#define LAMBENT_FIELD_PROBES_TILE_H

#include "shared/octahedral.h"

LAMBENT_BEGIN

/// Direction of the centre of an interior texel, each coordinate 0 to texels - 1.
LAMBENT_FN vec3 tile_direction(ivec2 texel, int texels) {
  vec2 p = (vec2(texel) + vec2(0.5f)) * (2.0f / float(texels)) - vec2(1.0f);
  return octahedral_decode(p);
}

/// A bilinear fetch from a tile: the lowest coordinates of its four texels, from 0 to `texels` with
/// the gutter included, and the weights of the texels at the next coordinate along each axis.
struct TileFetch {
  ivec2 corner;
  vec2 fraction;
};

LAMBENT_FN TileFetch tile_fetch(vec3 direction, int texels) {
  vec2 p = octahedral_encode(direction);
  vec2 t = (p + vec2(1.0f)) * (0.5f * float(texels)) + vec2(0.5f);
  // In this order of arguments a NaN, from a direction without length, becomes 0
  vec2 corner = min(max(vec2(0.0f), floor(t)), vec2(float(texels)));
  TileFetch fetch = {ivec2(corner), t - corner};
  return fetch;
}

/// The number of texels of the gutter.
LAMBENT_FN int gutter_texels(int texels) {
  return 4 * (texels + 1);
}

/// A texel of the gutter (coordinates with gutter). Indices run over the top row, then the bottom
/// row, then both sides.
LAMBENT_FN ivec2 gutter_texel(int index, int texels) {
  int width = texels + 2;
  if (index < width) return ivec2(index, 0);
  if (index < 2 * width) return ivec2(index - width, width - 1);
  int i = index - 2 * width;
  return ivec2((i & 1) * (width - 1), 1 + (i >> 1));
}

/// The interior texel (coordinates without gutter) that has the same value as a texel of the whole
/// tile (coordinates with gutter, 0 to texels + 1): itself, or the texel across the fold.
LAMBENT_FN ivec2 tile_source(ivec2 with_gutter, int texels) {
  ivec2 t = with_gutter - ivec2(1);
  bool beyond_x = t.x < 0 || t.x >= texels;
  bool beyond_y = t.y < 0 || t.y >= texels;
  ivec2 inside = ivec2(clamp(t.x, 0, texels - 1), clamp(t.y, 0, texels - 1));
  // Crossing an edge of the square mirrors the coordinate along that edge; a corner does both.
  ivec2 source = ivec2(beyond_y ? texels - 1 - inside.x : inside.x,
                       beyond_x ? texels - 1 - inside.y : inside.y);
  return source;
}

LAMBENT_END
#endif
