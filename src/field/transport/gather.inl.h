// SPDX-License-Identifier: Apache-2.0
// The radiance along probes' rays, in the common subset of C++ and GLSL. The includer provides the
// types
//   FieldRef          the texels of all probes, without gutters
//   SurfelLookupRef   a SurfelLookup
//   CornerOffsetsRef  a CornerOffsets
//   TapsRef           array of the four interior texels that a bilinear fetch reads
//   TileRef           the texels of a probe
// and
//   CornerOffsetsRef fetch_offsets(FieldRef field, uint table)
//   TapsRef fetch_taps(FieldRef field, uint tile_corner)
//   TileRef fetch_tile(FieldRef field, int probe)
//   vec4 fetch_texel(FieldRef field, TileRef tile, int texel)

/// The irradiance that a lookup reads from the field.
LAMBENT_FN vec4 read_field(FieldRef field, SurfelLookupRef lookup) {
  CornerOffsetsRef offsets = fetch_offsets(field, lookup.corners.table);
  TapsRef taps = fetch_taps(field, lookup.tile_corner);
  float fx = lookup.fraction_x;
  float fy = lookup.fraction_y;
  float tap_weights[4];
  tap_weights[0] = (1.0f - fx) * (1.0f - fy);
  tap_weights[1] = fx * (1.0f - fy);
  tap_weights[2] = (1.0f - fx) * fy;
  tap_weights[3] = fx * fy;
  vec4 sum = vec4(0.0f);
  for (int corner = 0; corner < kCellCorners; ++corner) {
    TileRef tile = fetch_tile(field, lookup.corners.base + offsets.probe[corner]);
    float weight = lookup.corners.weight[corner];
    for (int tap = 0; tap < 4; ++tap) {
      sum += (weight * tap_weights[tap]) * fetch_texel(field, tile, taps[tap]);
    }
  }
  return sum;
}
