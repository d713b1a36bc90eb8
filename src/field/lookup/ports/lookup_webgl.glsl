// SPDX-License-Identifier: Apache-2.0
// The lookup of Lambent's irradiance field for WebGL 2, to be put into a fragment shader of yours:
//   vec3 field_irradiance(vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws) -> [W/m^2]
// This is for points that a camera sees. It has no argument like FieldQuery::viewer_distance, and
// assumes that the viewer is farther away than the bias towards the viewer is long.
// This file is a port of src/field/lookup/lookup.inl.h and of the files included there, which give
// the reason for every constant. The build puts the constants in, and writes the complete file to
// its folder ports/, from which it is installed.
// Textures are those of LightTextures (src/stream/light/light_textures.h); tiles are filtered
// linearly. Before this file, #define LAMBENT_VOLUMES as the largest number of volumes.

// The build puts the constants of src/ here
@LAMBENT_CONSTANTS@

struct LambentGrid {  // as in probe_grid.h, where each member is explained
  vec3 origin_ws, spacing;
  mat3 axes;
  ivec3 count, scroll;
  int first;
  vec3 fade_centre, fade_half, fade_cells;
};
uniform LambentGrid lambent_grids[LAMBENT_VOLUMES];
uniform int lambent_volumes;
uniform ivec2 lambent_texels;  // of tiles of irradiance and of distances, without gutter
uniform highp sampler2D lambent_irradiance, lambent_distances, lambent_places;

float lambent_smallest(vec3 v) { return min(v.x, min(v.y, v.z)); }

// Fetches from a probe's tile of an atlas along a direction.
vec4 lambent_fetch(highp sampler2D atlas, int probe, vec3 direction, int texels) {
  vec2 p = direction.xy / max(abs(direction.x) + abs(direction.y) + abs(direction.z),
                              kTiniestLength);
  vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  vec2 t = ((direction.z < 0.0 ? folded : p) + 1.0) * (0.5 * float(texels));
  ivec2 size = textureSize(atlas, 0);
  int edge = texels + 2;
  int in_row = size.x / edge;
  vec2 corner = vec2(ivec2(probe % in_row, probe / in_row) * edge) + 1.0;
  return textureLod(atlas, (corner + t) / vec2(size), 0.0);
}

float lambent_probe_weight(float cos_probe, vec2 moments, float dist) {
  float beyond = max(dist - moments.x, 0.0);
  float variance = abs(moments.y - moments.x * moments.x);
  float bound = beyond > 0.0 ? variance / (variance + beyond * beyond) : 1.0;
  float wrap = max(0.0, (cos_probe + kWrapCosine) / (1.0 + kWrapCosine));
  float weight = wrap * wrap * bound * bound * bound;
  if (weight < kCrushThreshold) {
    weight *= weight * weight / (kCrushThreshold * kCrushThreshold);
  }
  // A probe inside geometry has a mean distance of 0, and no weight
  return moments.x > 0.0 ? max(weight, kMinVisibilityWeight) : 0.0;
}

// A volume's irradiance times its weight, and its weight, which is 0 where none of its probes has a
// weight.
vec4 lambent_volume(LambentGrid grid, vec3 coords, float volume_weight, vec3 position_ws,
                    vec3 normal_ws, vec3 to_viewer_ws) {
  vec3 biased_ws = position_ws + (kNormalBias * normal_ws + kViewBias * to_viewer_ws) *
                                     (kBiasScale * kBias * lambent_smallest(grid.spacing));
  uint longest_bits = floatBitsToUint(kMaxDistanceDiagonals * length(grid.spacing));
  float unit = exp2(float(int(longest_bits >> 23u) - kFloatBias - kDistanceUnitBits));
  vec3 cells = vec3(grid.count - ivec3(1));
  vec3 inside = clamp(coords, vec3(0.0), cells);
  vec3 base = min(floor(inside), cells - 1.0);
  vec4 sum = vec4(0.0);
  int in_row = textureSize(lambent_places, 0).x;
  for (int k = 0; k < 8; ++k) {
    ivec3 corner = ivec3(k & 1, (k >> 1) & 1, k >> 2);
    ivec3 place = (ivec3(base) + corner + grid.scroll) % grid.count;  // in memory
    int probe = grid.first + place.x + grid.count.x * (place.y + grid.count.y * place.z);
    vec3 probe_ws = texelFetch(lambent_places, ivec2(probe % in_row, probe / in_row), 0).xyz;
    vec3 from_probe = biased_ws - probe_ws;
    float dist = max(length(from_probe), kMinProbeDistance);
    vec3 to_probe = probe_ws - position_ws;
    float cos_probe = dot(to_probe, normal_ws) / max(length(to_probe), kMinProbeDistance);
    vec3 near = mix(1.0 - (inside - base), inside - base, vec3(corner));
    vec2 moments = vec2(unit, unit * unit) *
                   lambent_fetch(lambent_distances, probe, from_probe, lambent_texels.y).xy;
    float weight = near.x * near.y * near.z * lambent_probe_weight(cos_probe, moments, dist);
    vec3 light = lambent_fetch(lambent_irradiance, probe, normal_ws, lambent_texels.x).rgb;
    sum += weight * vec4(light, 1.0);
  }
  return sum.w > 0.0 ? vec4(sum.xyz / sum.w, 1.0) * volume_weight : vec4(0.0);
}

vec3 field_irradiance(vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws) {
  vec4 answer = vec4(0.0);
  for (int v = 0; v < lambent_volumes && answer.w < 1.0; ++v) {
    LambentGrid grid = lambent_grids[v];
    vec3 coords = ((position_ws - grid.origin_ws) * grid.axes) / grid.spacing;
    vec3 inside = grid.fade_half - abs(coords - grid.fade_centre);
    vec3 fade = inside / min(grid.fade_half, grid.fade_cells);
    float volume_weight = clamp(lambent_smallest(fade), 0.0, 1.0);
    if (v + 1 == lambent_volumes) volume_weight = 1.0;  // the last volume takes the rest
    if (volume_weight <= 0.0) continue;
    answer += lambent_volume(grid, coords, volume_weight * (1.0 - answer.w), position_ws, normal_ws,
                             to_viewer_ws);
  }
  return answer.w > 0.0 ? answer.xyz / answer.w : vec3(0.0);
}
