// SPDX-License-Identifier: Apache-2.0
// The lookup of Lambent's irradiance field for HLSL, to be included in a shader of yours:
//   field_irradiance(position_ws, normal_ws, to_viewer_ws) -> irradiance [W/m^2]
// This is for points that a camera sees. It has no argument like FieldQuery::viewer_distance, and
// assumes that the viewer is farther away than the bias towards the viewer is long.
// This file is a port of src/field/lookup/lookup.inl.h and of the files included there, which give
// the reason for every constant. The build puts the constants in, and writes the complete file to
// its folder ports/, from which it is installed.
// The buffers are those of a field's store. Distances are rg16f; the macros below choose the format
// of irradiance.

#ifndef LAMBENT_IRRADIANCE_TEXELS  // along a tile's edge, without gutter
#define LAMBENT_IRRADIANCE_TEXELS 4
#endif
#ifndef LAMBENT_DISTANCE_TEXELS
#define LAMBENT_DISTANCE_TEXELS 14
#endif
#ifndef LAMBENT_IRRADIANCE_R11G11B10F  // otherwise rgb9e5
#define LAMBENT_IRRADIANCE_R11G11B10F 0
#endif

// The build puts the constants of src/ here
@LAMBENT_CONSTANTS@

struct ProbeGrid {  // as in probe_grid.h, where each member is explained
  float origin_ws[3], spacing[3], axes[9];
  int count[3], scroll[3], first;
  float fade_centre[3], fade_half[3], fade_cells[3];
};
StructuredBuffer<ProbeGrid> field_grids : register(t0);   // one per volume
StructuredBuffer<uint> field_offsets : register(t1);      // one per probe
StructuredBuffer<uint> field_irradiances : register(t2);  // tile after tile
StructuredBuffer<uint> field_distances : register(t3);    // tile after tile

float3 vec3_of(float v[3]) { return float3(v[0], v[1], v[2]); }
int3 ivec3_of(int v[3]) { return int3(v[0], v[1], v[2]); }
float smallest(float3 v) { return min(v.x, min(v.y, v.z)); }
float3x3 rows_of(float axes[9]) {  // each row is an axis of the grid
  return float3x3(axes[0], axes[1], axes[2], axes[3], axes[4], axes[5], axes[6], axes[7], axes[8]);
}
float power_of_two(int exponent) { return asfloat(uint(exponent + kFloatBias) << 23); }

// A bilinear fetch from a tile: its first texel, and the weights of those to the right and below.
struct TileFetch {
  int first, row;
  float2 fraction;
};
TileFetch tile_fetch(int probe, float3 direction, int texels) {
  float2 p = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  float2 signs = float2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  if (direction.z < 0.0) p = (1.0 - abs(p.yx)) * signs;
  float2 t = (p + 1.0) * (0.5 * float(texels)) + 0.5;
  float2 corner = clamp(floor(t), 0.0, float(texels));
  int row = texels + 2;
  TileFetch fetch;
  fetch.first = (probe * row + int(corner.y)) * row + int(corner.x);
  fetch.row = row;
  fetch.fraction = t - corner;
  return fetch;
}

float small_float(uint bits, uint mantissa_bits) {
  return bits == 0 ? 0.0 : asfloat((bits << (23 - mantissa_bits)) + (kSmallFloatBiasShift << 23));
}
float3 irradiance_texel(int texel) {
  uint word = field_irradiances[texel];
#if LAMBENT_IRRADIANCE_R11G11B10F
  float3 e = float3(small_float(word & 0x7FF, 6), small_float((word >> 11) & 0x7FF, 6),
                    small_float(word >> 22, 5));
  return e * e * e * e * e;
#else
  return float3(word & 511, (word >> 9) & 511, (word >> 18) & 511) *
         power_of_two(int(word >> 27) - kRgb9e5BiasAndBits);
#endif
}
float3 irradiance_of(int probe, float3 direction) {
  TileFetch f = tile_fetch(probe, direction, LAMBENT_IRRADIANCE_TEXELS);
  int below = f.first + f.row;
  return lerp(lerp(irradiance_texel(f.first), irradiance_texel(f.first + 1), f.fraction.x),
              lerp(irradiance_texel(below), irradiance_texel(below + 1), f.fraction.x),
              f.fraction.y);
}
float2 moments_texel(int texel) {
  uint word = field_distances[texel];
  return f16tof32(uint2(word & 0xFFFF, word >> 16));
}
float2 moments_of(int probe, float3 direction, float unit) {
  TileFetch f = tile_fetch(probe, direction, LAMBENT_DISTANCE_TEXELS);
  int below = f.first + f.row;
  return float2(unit, unit * unit) *
         lerp(lerp(moments_texel(f.first), moments_texel(f.first + 1), f.fraction.x),
              lerp(moments_texel(below), moments_texel(below + 1), f.fraction.x), f.fraction.y);
}
float3 offset_of(int probe) {  // three signed numbers of 10 bits
  uint word = field_offsets[probe];
  int3 steps = int3(word << 22, word << 12, word << 2) >> 22;
  return float3(steps) * (kMaxProbeOffset / kOffsetSteps);
}

float probe_weight(float cos_probe, float2 moments, float dist) {
  float beyond = max(dist - moments.x, 0.0);
  float variance = abs(moments.y - moments.x * moments.x);
  float bound = beyond > 0.0 ? variance / (variance + beyond * beyond) : 1.0;
  float wrap = max(0.0, (cos_probe + kWrapCosine) / (1.0 + kWrapCosine));
  float weight = wrap * wrap * bound * bound * bound;
  if (weight < kCrushThreshold) weight *= weight * weight / (kCrushThreshold * kCrushThreshold);
  // A probe inside geometry has a mean distance of 0, and no weight
  return moments.x > 0.0 ? max(weight, kMinVisibilityWeight) : 0.0;
}

// A volume's irradiance times its weight, and its weight, which is 0 where none of its probes has a
// weight.
float4 volume_irradiance(ProbeGrid grid, float3 coords, float volume_weight, float3 position_ws,
                         float3 normal_ws, float3 to_viewer_ws) {
  float3 spacing = vec3_of(grid.spacing);
  float3x3 axes = rows_of(grid.axes);
  int3 count = ivec3_of(grid.count);
  float3 biased_ws = position_ws + (kNormalBias * normal_ws + kViewBias * to_viewer_ws) *
                                       (kBiasScale * kBias * smallest(spacing));
  uint longest_bits = asuint(kMaxDistanceDiagonals * length(spacing));
  float unit = power_of_two(int(longest_bits >> 23) - kFloatBias - kDistanceUnitBits);
  float3 cells = float3(count - 1);
  float3 inside = clamp(coords, 0.0, cells);
  float3 base = min(floor(inside), cells - 1.0);
  float4 sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    int3 corner = int3(k & 1, (k >> 1) & 1, k >> 2);
    int3 place = (int3(base) + corner + ivec3_of(grid.scroll)) % count;  // in memory
    int probe = grid.first + place.x + count.x * (place.y + count.y * place.z);
    float3 probe_cells = base + float3(corner) + offset_of(probe);
    float3 probe_ws = vec3_of(grid.origin_ws) + mul(spacing * probe_cells, axes);
    float3 from_probe = biased_ws - probe_ws;
    float dist = max(length(from_probe), kMinProbeDistance);
    float3 to_probe = probe_ws - position_ws;
    float cos_probe = dot(to_probe, normal_ws) / max(length(to_probe), kMinProbeDistance);
    float3 near = lerp(1.0 - (inside - base), inside - base, float3(corner));
    float weight = near.x * near.y * near.z *
                   probe_weight(cos_probe, moments_of(probe, from_probe / dist, unit), dist);
    sum += weight * float4(irradiance_of(probe, normal_ws), 1.0);
  }
  return sum.w > 0.0 ? float4(sum.xyz / sum.w, 1.0) * volume_weight : 0.0;
}

float3 field_irradiance(float3 position_ws, float3 normal_ws, float3 to_viewer_ws) {
  float4 answer = 0.0;
  uint volumes, stride;
  field_grids.GetDimensions(volumes, stride);
  for (uint v = 0; v < volumes && answer.w < 1.0; ++v) {
    ProbeGrid grid = field_grids[v];
    float3 coords =
        mul(rows_of(grid.axes), position_ws - vec3_of(grid.origin_ws)) / vec3_of(grid.spacing);
    float3 half_box = vec3_of(grid.fade_half);
    float3 inside = half_box - abs(coords - vec3_of(grid.fade_centre));
    float volume_weight = saturate(smallest(inside / min(half_box, vec3_of(grid.fade_cells))));
    if (v + 1 == volumes) volume_weight = 1.0;  // the last volume takes the rest
    if (volume_weight <= 0.0) continue;
    answer += volume_irradiance(grid, coords, volume_weight * (1.0 - answer.w), position_ws,
                                normal_ws, to_viewer_ws);
  }
  return answer.w > 0.0 ? answer.xyz / answer.w : 0.0;
}
