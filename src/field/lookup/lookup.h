// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019; Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global
// Illumination for Production", JCGT 10(2), 2021. The weights of the eight probes around a point.
#ifndef LAMBENT_FIELD_LOOKUP_LOOKUP_H
#define LAMBENT_FIELD_LOOKUP_LOOKUP_H

#include "field/lookup/lookup_records.h"
#include "field/probes/tile.h"

LAMBENT_BEGIN

// Visibility is evaluated at a biased position, off the surface along the normal and towards the
// viewer by kBiasScale * kBias * (smallest probe spacing). That is far enough that the surface does
// not shadow itself in statistics as coarse as a tile's texels, but not so far that it passes
// through a thin wall. JCGT 2021, sec. 3: 0.2, 0.8, 0.75 and B = 0.3.
const float kNormalBias = 0.2f;
const float kViewBias = 0.8f;
const float kBiasScale = 0.75f;
const float kBias = 0.3f;

// The bias towards the viewer is at most this share of the distance to the viewer. A ray that
// gathers light in a corner ends a few centimetres from its origin, so that the whole bias would
// lead through the wall at the origin, to probes outdoors. With one half, the biased position is
// equally far from both ends.
const float kMaxViewBiasShare = 0.5f;

// The weight of a probe falls with the cosine between the normal and the direction to the probe,
// and is 0 where that cosine is below -kWrapCosine, behind the surface. The published value is 1
// (JCGT 8(2) 2019). Where probes stand just in front of both sides of a thin wall, those of the far
// side then count too much: in the two rooms of `scripts/measure leaks` with probes 1 m apart, the
// mean light behind the sealed wall is 1.0 % of that with the door open, and 0.14 % with this
// value. A smaller value costs accuracy.
const float kWrapCosine = 0.5f;

// Weights below this threshold are replaced by their cube over its square, so that nearly hidden
// probes fade out instead of leaking light.
const float kCrushThreshold = 0.2f;

// The least weight of a probe. Where every probe seems hidden, trilinear interpolation alone
// decides.
const float kMinVisibilityWeight = 1e-6f;

// The least distance between a point and a probe [m]. It keeps the direction between them finite
// where both are at the same place.
const float kMinProbeDistance = 1e-6f;

// These keep divisions finite: by the length of a direction [m], and where distances have no
// variance [distance_unit^2]. They are far below the resolution of the results.
const float kTiniestLength = 1e-12f;
const float kTiniestSquare = 1e-20f;

// A remaining weight below this, after some volumes have taken theirs, is a rounding error.
const float kMinRemainingWeight = 1e-6f;

/// The point at which visibility is evaluated, seen by a viewer at this distance [m].
LAMBENT_FN vec3 biased_position(vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                                float viewer_distance, float spacing_min) {
  float bias = kBiasScale * kBias * spacing_min;
  return position_ws + kNormalBias * bias * normal_ws +
         min(kViewBias * bias, kMaxViewBiasShare * viewer_distance) * to_viewer_ws;
}

/// A bilinear fetch of distances. Agrees with tile_fetch() of probes/tile.h but for rounding: it
/// divides once, has no branches, and takes directions of any length, 0 included. Its first half is
/// octahedral_encode() of shared/octahedral.h, written so that loops over it become vector code.
LAMBENT_FN TileFetch moments_fetch(vec3 direction, int texels) {
  float l1_norm = abs(direction.x) + abs(direction.y) + abs(direction.z);
  float inverse = 1.0f / max(kTiniestLength, l1_norm);
  float x = direction.x * inverse;
  float y = direction.y * inverse;
  float folded_x = (1.0f - abs(y)) * sign_not_zero(x);
  float folded_y = (1.0f - abs(x)) * sign_not_zero(y);
  float last = float(texels);
  float u = ((direction.z < 0.0f ? folded_x : x) + 1.0f) * (0.5f * last) + 0.5f;
  float v = ((direction.z < 0.0f ? folded_y : y) + 1.0f) * (0.5f * last) + 0.5f;
  // u and v lie in [0.5, texels + 0.5], so truncation is floor
  ivec2 corner = ivec2(int(u < last ? u : last), int(v < last ? v : last));
  TileFetch fetch = {corner, vec2(u - float(corner.x), v - float(corner.y))};
  return fetch;
}

/// Interpolates the moments of four texels: the fetch's first one, and those to its right, below
/// it, and below to the right.
LAMBENT_FN vec2 bilinear_moments(vec2 first, vec2 right, vec2 below, vec2 beyond, vec2 fraction) {
  return mix(mix(first, right, fraction.x), mix(below, beyond, fraction.x), fraction.y);
}

/// Visibility over a distance, from the mean and the mean square of the distances to occluders, all
/// in distance_unit() of the grid. Chebyshev's one-sided inequality gives an upper bound on the
/// fraction of light paths that are not blocked (Donnelly and Lauritzen, "Variance Shadow Maps",
/// I3D 2006, Eq. 5). Its cube (JCGT 10(2) 2021) is no longer a bound, but darkens leaks: when it
/// was introduced, the mean of `scripts/measure leaks` fell from 5.0 % (the bound) to 0.4 % (the
/// cube).
LAMBENT_FN float chebyshev_visibility(vec2 moments, float dist) {
  float variance = abs(moments.y - moments.x * moments.x);
  float beyond = dist - moments.x;
  float bound = variance / (variance + beyond * beyond + kTiniestSquare);
  return beyond <= 0.0f ? 1.0f : bound * bound * bound;
}

/// The wrap-shading weight of a probe: 1 straight in front of the surface, falling off smoothly
/// towards its back. `cos_probe` is the cosine between the surface normal and the direction to the
/// probe. The published weight adds a floor of 0.2, which lets light through thin sheets and costs
/// accuracy.
LAMBENT_FN float wrap_weight(float cos_probe) {
  float wrap = max(0.0f, (cos_probe + kWrapCosine) / (1.0f + kWrapCosine));
  return wrap * wrap;
}

/// The weight, or below kCrushThreshold its `cube`: the weight's cube over the square of
/// kCrushThreshold.
LAMBENT_FN float crushed_weight(float weight, float cube) {
  float chosen = weight < kCrushThreshold ? cube : weight;
  return chosen > kMinVisibilityWeight ? chosen : kMinVisibilityWeight;
}

/// The weight of a probe before trilinear interpolation, from its wrap-shading weight and
/// visibility.
LAMBENT_FN float combined_weight(float wrap, float visibility) {
  float weight = wrap * visibility;
  return crushed_weight(weight,
                        weight * weight * weight * (1.0f / (kCrushThreshold * kCrushThreshold)));
}

/// What the lookups in a grid have in common.
struct LookupGrid {
  ProbeGrid grid;
  float spacing_min;      ///< smallest_spacing() [m]
  float units_per_metre;  ///< Units of the stored distances in a metre.
};

LAMBENT_FN LookupGrid lookup_grid(ProbeGrid grid) {
  LookupGrid result = {grid, smallest_spacing(grid), 1.0f / distance_unit(grid)};
  return result;
}

/// What the corners of the cell around a point have in common.
struct LookupCell {
  ProbeCell cell;
  vec3 lowest_ws;  ///< The place on the grid of the cell's lowest probe.
  vec3 biased_ws;  ///< The point at which visibility is evaluated.
};

LAMBENT_FN LookupCell lookup_cell(LookupGrid volume, vec3 position_ws, vec3 normal_ws,
                                  vec3 to_viewer_ws, float viewer_distance) {
  ProbeCell cell = probe_cell(volume.grid, position_ws);
  LookupCell result = {
      cell, probe_position(volume.grid, cell.base),
      biased_position(position_ws, normal_ws, to_viewer_ws, viewer_distance, volume.spacing_min)};
  return result;
}

/// What is known of a corner before its distances are read.
struct LookupCorner {
  vec3 from_probe;  ///< From the probe to the biased point [m].
  float dist;       ///< The length of that [distance_unit].
  float trilinear;
  float wrap;  ///< Wrap-shading weight, 0 to 1.
};

/// `offset` is the offset of the corner's probe from its place on the grid [cells].
LAMBENT_FN LookupCorner lookup_corner(LookupGrid volume, LookupCell cell, ivec3 corner, vec3 offset,
                                      vec3 position_ws, vec3 normal_ws) {
  // Compute where the probe is
  vec3 spacing = volume.grid.spacing;
  vec3 way = vec3(corner.x != 0 ? spacing.x : 0.0f, corner.y != 0 ? spacing.y : 0.0f,
                  corner.z != 0 ? spacing.z : 0.0f) +
             offset * spacing;
  vec3 probe_ws = cell.lowest_ws + volume.grid.axes * way;

  // Compute on which side of the surface that is
  vec3 to_probe = probe_ws - position_ws;
  float length_squared = dot(to_probe, to_probe);
  float cosine =
      dot(to_probe, normal_ws) / sqrt(max(kMinProbeDistance * kMinProbeDistance, length_squared));

  vec3 from_probe = cell.biased_ws - probe_ws;
  LookupCorner result = {from_probe, sqrt(dot(from_probe, from_probe)) * volume.units_per_metre,
                         trilinear_weight(cell.cell.fraction, corner), wrap_weight(cosine)};
  return result;
}

/// The weight of a corner, from the moments that its probe stores [distance_unit]. A probe inside
/// geometry stores a mean distance of 0. It has no light and no weight, even where all other probes
/// are hidden.
LAMBENT_FN float corner_weight(float wrap, float trilinear, float dist, vec2 moments) {
  float weight = combined_weight(wrap, chebyshev_visibility(moments, dist));
  return (moments.x > 0.0f ? weight : 0.0f) * trilinear;
}

LAMBENT_END
#endif
