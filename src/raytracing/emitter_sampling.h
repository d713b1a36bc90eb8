// SPDX-License-Identifier: Apache-2.0
// Emissive triangles as lights: drawn by power or by cosine, weighted by both densities.
#ifndef LAMBENT_RAYTRACING_EMITTER_SAMPLING_H
#define LAMBENT_RAYTRACING_EMITTER_SAMPLING_H

#include "raytracing/shadow_rays.h"
#include "scene/emissive_sample.h"
#include "shared/random.h"
#include "shared/rays.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// Light from one direction, if nothing is in the way.
struct LightCandidate {
  vec3 to_light;                  ///< Unit.
  float distance;                 ///< To the source [m]; infinite for directional lights.
  vec3 perpendicular_irradiance;  ///< On a surface that faces the source [W/m^2].
};

/// A candidate that brings nothing.
LAMBENT_FN LightCandidate no_candidate() {
  LightCandidate none = {vec3(0.0f), 0.0f, vec3(0.0f)};
  return none;
}

/// The ray that asks whether a candidate reaches a point; the geometric normal is on the lit side.
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

/// Share of the samples of emissive surfaces that follow the cosine instead of the sources' power.
/// Power alone is best for far lamps, but a point near an emitter then gets rare, enormous samples:
/// the mixed density bounds them by pi / kCosineShare times the radiance.
const float kCosineShare = 0.1f;

/// An emitter seen edge on subtends nothing: no density is too high for it. Cosines are at least
/// this.
const float kMinEmitterCosine = 1e-6f;

/// What is drawn to find a point on an emissive triangle.
struct EmitterDraw {
  uint by_cosine;  ///< 1: about the normal, by u.y and u.z; 0: by power.
  vec3 u;          ///< Uniform; u.x picks the triangle.
};

/// The draw for sample `i` of 1 / `share` samples of a point.
LAMBENT_FN EmitterDraw draw_emitter(LAMBENT_INOUT(RandomStream) random, int i, float share) {
  uint by_cosine = next_uniform(random) < kCosineShare ? 1u : 0u;
  // Stratify the choice of the triangle over the samples
  float u = (float(i) + next_uniform(random)) * share;
  vec2 v = next_uniform2(random);
  EmitterDraw result = {by_cosine, vec3(u, v.x, v.y)};
  return result;
}

/// A direction about a normal, drawn by the cosine.
LAMBENT_FN vec3 sample_cosine_about(vec3 normal, vec2 u) {
  return to_world(make_frame(normal), sample_cosine_hemisphere(u));
}

/// Where an emissive triangle was found, and with which density.
struct EmitterPoint {
  vec3 to_light;    ///< Unit.
  float distance;   ///< [m]
  vec3 radiance;    ///< [W/(m^2 sr)]; 0: nothing was found.
  float pdf_power;  ///< With which sampling by power finds it [1/sr].
};

LAMBENT_FN EmitterPoint no_emitter() {
  EmitterPoint none = {vec3(0.0f), 0.0f, vec3(0.0f), 0.0f};
  return none;
}

/// Density over solid angle [1/sr] of a point drawn with a density over area [1/m^2], seen under a
/// cosine.
LAMBENT_FN float solid_angle_pdf(float pdf_area, float squared_distance, float cosine) {
  return pdf_area * squared_distance / max(cosine, kMinEmitterCosine);
}

/// A point of an emissive triangle, drawn or met by a ray, as seen from `position_ws`.
LAMBENT_FN EmitterPoint emitter_seen(EmissiveSample drawn, vec3 position_ws) {
  vec3 offset = drawn.position_ws - position_ws;
  float squared = dot(offset, offset);
  EmitterPoint emitter = no_emitter();
  if (drawn.pdf_area <= 0.0f || squared <= 0.0f) return emitter;
  emitter.distance = sqrt(squared);
  emitter.to_light = offset / emitter.distance;
  emitter.radiance = drawn.radiance;
  emitter.pdf_power =
      solid_angle_pdf(drawn.pdf_area, squared, abs(dot(drawn.normal_ws, emitter.to_light)));
  return emitter;
}

/// What one of 1 / `share` samples of emitters sends to a point with this normal: the balance
/// heuristic of one sample. Veach, "Robust Monte Carlo Methods for Light Transport Simulation",
/// 1997, sec. 9.2.4.
LAMBENT_FN LightCandidate emitter_candidate(EmitterPoint emitter, vec3 normal_ws, float share) {
  float pdf_cosine = pdf_cosine_hemisphere(dot(normal_ws, emitter.to_light));
  float pdf = mix(emitter.pdf_power, pdf_cosine, kCosineShare);
  LightCandidate candidate = {emitter.to_light, emitter.distance, emitter.radiance * (share / pdf)};
  return candidate;
}

LAMBENT_END
#endif
