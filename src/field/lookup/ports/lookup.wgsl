// SPDX-License-Identifier: Apache-2.0
// The lookup of Lambent's irradiance field for WebGPU, to be put before a shader of yours:
//   field_irradiance(position_ws, normal_ws, to_viewer_ws) -> irradiance [W/m^2]
// This is for points that a camera sees. It has no argument like FieldQuery::viewer_distance, and
// assumes that the viewer is farther away than the bias towards the viewer is long.
// This file is a port of src/field/lookup/lookup.inl.h and of the files included there, which give
// the reason for every constant. The build puts the constants in, and writes the complete file to
// its folder ports/, from which it is installed.
// The buffers are those of a field's store. Distances are rg16f; the overrides below choose the
// format of irradiance.

override irradiance_texels: i32 = 4;  // along a tile's edge, without gutter
override distance_texels: i32 = 14;
override irradiance_r11g11b10f: bool = false;  // otherwise rgb9e5

// The build puts the constants of src/ here
@LAMBENT_CONSTANTS@

alias Float3 = array<f32, 3>;  // 12 bytes, where a vec3f would take 16
alias Int3 = array<i32, 3>;
struct ProbeGrid {  // as in probe_grid.h, where each member is explained
  origin_ws: Float3, spacing: Float3, axes: array<Float3, 3>,
  count: Int3, scroll: Int3, first: i32,
  fade_centre: Float3, fade_half: Float3, fade_cells: Float3,
}
const kFieldGroup = 0;  // where the buffers are bound
// One grid per volume, one offset per probe, and the words of the tiles, tile after tile.
@group(kFieldGroup) @binding(0) var<storage, read> field_grids: array<ProbeGrid>;
@group(kFieldGroup) @binding(1) var<storage, read> field_offsets: array<u32>;
@group(kFieldGroup) @binding(2) var<storage, read> field_irradiances: array<u32>;
@group(kFieldGroup) @binding(3) var<storage, read> field_distances: array<u32>;

fn vec3_of(v: Float3) -> vec3f { return vec3f(v[0], v[1], v[2]); }
fn ivec3_of(v: Int3) -> vec3i { return vec3i(v[0], v[1], v[2]); }
fn smallest(v: vec3f) -> f32 { return min(v.x, min(v.y, v.z)); }
fn axes_of(grid: ProbeGrid) -> mat3x3f {
  return mat3x3f(vec3_of(grid.axes[0]), vec3_of(grid.axes[1]), vec3_of(grid.axes[2]));
}
fn power_of_two(exponent: i32) -> f32 { return bitcast<f32>(u32(exponent + kFloatBias) << 23u); }

// A bilinear fetch from a tile: its first texel, and the weights of those to the right and below.
struct TileFetch { first: i32, row: i32, fraction: vec2f }
fn tile_fetch(probe: i32, direction: vec3f, texels: i32) -> TileFetch {
  let p = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  let folded = (1.0 - abs(p.yx)) * select(vec2f(-1.0), vec2f(1.0), p >= vec2f(0.0));
  let t = (select(p, folded, direction.z < 0.0) + 1.0) * (0.5 * f32(texels)) + 0.5;
  let corner = clamp(floor(t), vec2f(0.0), vec2f(f32(texels)));
  let row = texels + 2;
  return TileFetch((probe * row + i32(corner.y)) * row + i32(corner.x), row, t - corner);
}

fn small_floats(bits: vec3u, mantissa_bits: vec3u) -> vec3f {
  let moved = (bits << (vec3u(23u) - mantissa_bits)) + (kSmallFloatBiasShift << 23u);
  return select(bitcast<vec3f>(moved), vec3f(0.0), bits == vec3u(0u));
}
fn irradiance_texel(texel: i32) -> vec3f {
  let word = field_irradiances[texel];
  if irradiance_r11g11b10f {
    let e = small_floats(vec3u(word, word >> 11u, word >> 22u) & vec3u(0x7FFu, 0x7FFu, 0x3FFu),
                         vec3u(6u, 6u, 5u));
    return e * e * e * e * e;
  }
  return vec3f(vec3u(word, word >> 9u, word >> 18u) & vec3u(511u)) *
         power_of_two(i32(word >> 27u) - kRgb9e5BiasAndBits);
}
fn irradiance_of(probe: i32, direction: vec3f) -> vec3f {
  let f = tile_fetch(probe, direction, irradiance_texels);
  let below = f.first + f.row;
  return mix(mix(irradiance_texel(f.first), irradiance_texel(f.first + 1), f.fraction.x),
             mix(irradiance_texel(below), irradiance_texel(below + 1), f.fraction.x),
             f.fraction.y);
}
fn moments_texel(texel: i32) -> vec2f { return unpack2x16float(field_distances[texel]); }
fn moments_of(probe: i32, direction: vec3f, unit: f32) -> vec2f {
  let f = tile_fetch(probe, direction, distance_texels);
  let below = f.first + f.row;
  return vec2f(unit, unit * unit) *
         mix(mix(moments_texel(f.first), moments_texel(f.first + 1), f.fraction.x),
             mix(moments_texel(below), moments_texel(below + 1), f.fraction.x), f.fraction.y);
}
fn offset_of(probe: i32) -> vec3f {  // three signed numbers of 10 bits
  let word = field_offsets[probe];
  let steps = vec3i(vec3u(word << 22u, word << 12u, word << 2u)) >> vec3u(22u);
  return vec3f(steps) * (kMaxProbeOffset / kOffsetSteps);
}

fn probe_weight(cos_probe: f32, moments: vec2f, dist: f32) -> f32 {
  let beyond = max(dist - moments.x, 0.0);
  let variance = abs(moments.y - moments.x * moments.x);
  var bound = 1.0;
  if beyond > 0.0 { bound = variance / (variance + beyond * beyond); }
  let wrap = max(0.0, (cos_probe + kWrapCosine) / (1.0 + kWrapCosine));
  var weight = wrap * wrap * bound * bound * bound;
  if weight < kCrushThreshold { weight *= weight * weight / (kCrushThreshold * kCrushThreshold); }
  // A probe inside geometry has a mean distance of 0, and no weight
  return select(0.0, max(weight, kMinVisibilityWeight), moments.x > 0.0);
}

// A volume's irradiance times its weight, and its weight, which is 0 where none of its probes has a
// weight.
fn volume_irradiance(grid: ProbeGrid, coords: vec3f, volume_weight: f32, position_ws: vec3f,
                     normal_ws: vec3f, to_viewer_ws: vec3f) -> vec4f {
  let spacing = vec3_of(grid.spacing);
  let axes = axes_of(grid);
  let count = ivec3_of(grid.count);
  let biased_ws = position_ws + (kNormalBias * normal_ws + kViewBias * to_viewer_ws) *
                                    (kBiasScale * kBias * smallest(spacing));
  let longest_bits = bitcast<u32>(kMaxDistanceDiagonals * length(spacing));
  let unit = power_of_two(i32(longest_bits >> 23u) - kFloatBias - kDistanceUnitBits);
  let cells = vec3f(count - vec3i(1));
  let inside = clamp(coords, vec3f(0.0), cells);
  let base = min(floor(inside), cells - 1.0);
  var sum = vec4f(0.0);
  for (var k = 0; k < 8; k++) {
    let corner = vec3i(k & 1, (k >> 1u) & 1, k >> 2u);
    let place = (vec3i(base) + corner + ivec3_of(grid.scroll)) % count;  // in memory
    let probe = grid.first + place.x + count.x * (place.y + count.y * place.z);
    let probe_cells = base + vec3f(corner) + offset_of(probe);
    let probe_ws = vec3_of(grid.origin_ws) + axes * (spacing * probe_cells);
    let from_probe = biased_ws - probe_ws;
    let dist = max(length(from_probe), kMinProbeDistance);
    let to_probe = probe_ws - position_ws;
    let cos_probe = dot(to_probe, normal_ws) / max(length(to_probe), kMinProbeDistance);
    let near = mix(1.0 - (inside - base), inside - base, vec3f(corner));
    let weight = near.x * near.y * near.z *
                 probe_weight(cos_probe, moments_of(probe, from_probe / dist, unit), dist);
    sum += weight * vec4f(irradiance_of(probe, normal_ws), 1.0);
  }
  if sum.w <= 0.0 { return vec4f(0.0); }
  return vec4f(sum.xyz / sum.w, 1.0) * volume_weight;
}

fn field_irradiance(position_ws: vec3f, normal_ws: vec3f, to_viewer_ws: vec3f) -> vec3f {
  var answer = vec4f(0.0);
  let volumes = arrayLength(&field_grids);
  for (var v = 0u; v < volumes && answer.w < 1.0; v++) {
    let grid = field_grids[v];
    let coords = ((position_ws - vec3_of(grid.origin_ws)) * axes_of(grid)) / vec3_of(grid.spacing);
    let half_box = vec3_of(grid.fade_half);
    let inside = half_box - abs(coords - vec3_of(grid.fade_centre));
    var volume_weight = saturate(smallest(inside / min(half_box, vec3_of(grid.fade_cells))));
    if v + 1u == volumes { volume_weight = 1.0; }  // the last volume takes the rest
    if volume_weight <= 0.0 { continue; }
    answer += volume_irradiance(grid, coords, volume_weight * (1.0 - answer.w), position_ws,
                                normal_ws, to_viewer_ws);
  }
  if answer.w <= 0.0 { return vec3f(0.0); }
  return answer.xyz / answer.w;
}
