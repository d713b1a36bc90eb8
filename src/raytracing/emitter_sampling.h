// SPDX-License-Identifier: Apache-2.0
// Emissive triangles as lights: points on them are sampled by their solid angle at the lit point.
#ifndef LAMBENT_RAYTRACING_EMITTER_SAMPLING_H
#define LAMBENT_RAYTRACING_EMITTER_SAMPLING_H

#include "raytracing/coat_share.h"
#include "raytracing/shadow_rays.h"
#include "scene/light_tree/light_tree_math.h"
#include "shared/random.h"
#include "shared/rays.h"
#include "shared/reservoir.h"
#include "shared/sampling.h"
#include "shared/spherical_triangle.h"

LAMBENT_BEGIN

/// Unoccluded light from one direction.
struct LightCandidate {
  vec3 to_light;                  ///< Unit.
  float distance;                 ///< To the source [m]; infinite for directional lights.
  vec3 perpendicular_irradiance;  ///< On a surface that faces the source [W/m^2].
  /// emission_luminance() of an emissive surface, which rays can hit, too [W/(m^2 sr)]; 0 for
  /// others.
  float emission_luminance;
};

/// A candidate without light.
LAMBENT_FN LightCandidate no_candidate() {
  LightCandidate none = {vec3(0.0f), 0.0f, vec3(0.0f), 0.0f};
  return none;
}

/// The shadow ray to a candidate; the geometric normal is on the lit side.
LAMBENT_FN RayRecord shadow_ray_record(vec3 position_ws, vec3 geometric_normal_ws,
                                       LightCandidate light) {
  bool endless = floatBitsToUint(light.distance) == kMissedDistanceBits;
  vec3 source_ws = position_ws + (endless ? 1.0f : light.distance) * light.to_light;
  RayRecord ray = ray_to_point(position_ws, geometric_normal_ws, source_ws, kRayMeetsAll);
  if (endless) {
    ray.direction_ws = light.to_light;
    ray.t_max = light.distance;
  }
  return ray;
}

/// A direction about a normal, drawn in proportion to the cosine.
LAMBENT_FN vec3 sample_cosine_about(vec3 normal, vec2 u) {
  return to_world(make_frame(normal), sample_cosine_hemisphere(u));
}

/// Angle between a triangle's corners [rad] below which it is sampled by area: distance and cosine
/// vary over it by a few percent, and that is cheaper.
const float kSmallTriangle = 0.02f;

/// Height of a point over the plane of a triangle that surrounds it, relative to the triangle's
/// size, below which the point counts as lying on it: the rounding of the corners is of that order.
const float kOnTriangle = 1e-6f;

/// A point sampled on a triangle, as seen from a lit point.
struct TrianglePointSeen {
  vec2 barycentrics;
  vec3 to_point;   ///< Unit.
  float distance;  ///< [m]
  float pdf;       ///< Over solid angle [1/sr]; 0: there is no sample, the triangle is not visible.
};

/// Samples a point of a triangle, given by its corners relative to the lit point, from a uniform
/// point of the unit square: evenly over the solid angle that the triangle subtends, or over its
/// area where it is small. The light of a sample is therefore bounded, however near the triangle
/// is.
LAMBENT_FN TrianglePointSeen draw_on_triangle(vec3 a, vec3 edge1, vec3 edge2, vec2 u) {
  TrianglePointSeen seen = {vec2(0.0f), vec3(0.0f), 0.0f, 0.0f};
  vec3 b = a + edge1;
  vec3 c = a + edge2;
  vec3 squares = vec3(dot(a, a), dot(b, b), dot(c, c));
  if (min(squares.x, min(squares.y, squares.z)) <= 0.0f) return seen;
  vec3 unit_a = a * inversesqrt(squares.x);
  vec3 unit_b = b * inversesqrt(squares.y);
  vec3 unit_c = c * inversesqrt(squares.z);
  vec3 ab = unit_b - unit_a;
  vec3 ac = unit_c - unit_a;
  vec3 normal = cross(edge1, edge2);

  if (max(dot(ab, ab), dot(ac, ac)) < kSmallTriangle * kSmallTriangle) {
    seen.barycentrics = sample_uniform_triangle(u);
  } else {
    SphericalTriangle triangle = spherical_triangle(unit_a, unit_b, unit_c);
    bool around = triangle.solid_angle > kPi;
    if (triangle.solid_angle <= 0.0f || (around && triangle.volume < kOnTriangle)) return seen;
    // Find the barycentrics by the volumes that the direction spans with the triangle's edges
    vec3 direction = sample_spherical_triangle(triangle, u);
    float total = dot(direction, normal);
    if (total == 0.0f) return seen;
    float weight_b = clamp(dot(direction, cross(c, a)) / total, 0.0f, 1.0f);
    float weight_c = clamp(dot(direction, cross(a, b)) / total, 0.0f, 1.0f - weight_b);
    seen.barycentrics = vec2(weight_b, weight_c);
    seen.pdf = 1.0f / triangle.solid_angle;
  }
  vec3 offset = a + seen.barycentrics.x * edge1 + seen.barycentrics.y * edge2;
  float squared = dot(offset, offset);
  if (squared <= 0.0f) {
    seen.pdf = 0.0f;
    return seen;
  }
  seen.distance = sqrt(squared);
  seen.to_point = offset / seen.distance;
  if (seen.pdf == 0.0f) {
    float projected_area = 0.5f * abs(dot(normal, seen.to_point));
    seen.pdf = projected_area > 0.0f ? squared / projected_area : 0.0f;
  }
  return seen;
}

/// Rounding of a world position relative to its distance from the world's origin: eight float
/// steps, to allow for the transform and the barycentrics besides the result.
const float kPositionRounding = 1e-6f;

/// Whether a point at which a triangle fills more than half of a hemisphere lies on it, within the
/// rounding of world positions. A point of an emissive triangle receives nothing from the triangle;
/// where rounding puts it above, it would receive all of the triangle's radiance.
LAMBENT_FN bool lies_on_triangle(vec3 position_ws, vec3 corner_ws, vec3 edge1, vec3 edge2,
                                 TrianglePointSeen seen) {
  if (seen.pdf * kPi >= 1.0f) return false;
  vec3 normal = cross(edge1, edge2);
  float rounding = kPositionRounding * max(length(position_ws), length(corner_ws));
  return abs(dot(normal, corner_ws - position_ws)) <= rounding * length(normal);
}

/// Total number of candidates from which a point's samples of the light tree are resampled, and the
/// least number for each sample. Candidates cost no ray; with more of them, fewer rays go where
/// there is little light.
const uint kCandidates = 4u;
const uint kMinCandidates = 2u;

/// Total number of candidates at hits of probe rays, of gathering rays and of rays that train
/// corrections. With kCandidates, gathers take 1.2 to 1.4 times as long; they have .3 % less noise
/// in cornell, 2 % less in a street under 40 lamps, and 17 % less in an office whose ceiling is of
/// light panels. Shading of surfels takes 1.2 to 1.8 times as long, and pictures differ little
/// (docs/performance.md).
const uint kSecondaryCandidates = 2u;

/// Number of candidates for one sample of the light tree, at least kMinCandidates: an equal share
/// of a point's `candidates`, 1 to kMostPicks (kCandidates unless a pass asks for fewer), among its
/// `samples`, >= 1.
LAMBENT_FN uint candidates_per_sample(uint candidates, uint samples) {
  return max(candidates / samples, kMinCandidates);
}

/// Resampled importance sampling of one light out of a stream of candidates.
struct Resampling {
  LightCandidate chosen;
  Reservoir reservoir;
};

LAMBENT_FN Resampling begin_resampling(float u) {
  Resampling resampling = {no_candidate(), begin_reservoir(u)};
  return resampling;
}

/// Offers a candidate, which is chosen with a probability in proportion to its target.
LAMBENT_FN void offer(LAMBENT_INOUT(Resampling) resampling, LightCandidate candidate,
                      float target) {
  if (accepts(resampling.reservoir, target)) resampling.chosen = candidate;
}

/// The chosen candidate, weighted such that its expected light is that of all candidates together,
/// times `scale`.
LAMBENT_FN LightCandidate resampled(Resampling resampling, float scale) {
  LightCandidate candidate = resampling.chosen;
  candidate.perpendicular_irradiance *= scale * resampling_weight(resampling.reservoir);
  return candidate;
}

LAMBENT_END
#endif
