// SPDX-License-Identifier: Apache-2.0
// Light that sources send straight to a point: one candidate a light, and some points of the
// emissive triangles.
#pragma once

#include <cmath>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "scene/light_sampling.h"
#include "shared/random.h"
#include "shared/rays.h"
#include "shared/sampling.h"

namespace lambent {

/// Light from one direction, if nothing is in the way.
struct LightCandidate {
  glm::vec3 to_light;                  ///< Unit.
  float distance;                      ///< To the source [m]; infinite for directional lights.
  glm::vec3 perpendicular_irradiance;  ///< On a surface that faces the source [W/m^2].
};

/// The ray that asks whether a candidate reaches a point; the geometric normal is on the lit side.
inline Ray shadow_ray(const glm::vec3& position_ws, const glm::vec3& geometric_normal_ws,
                      const LightCandidate& light) {
  return {offset_ray_origin(position_ws, geometric_normal_ws), 0.0f, light.to_light,
          light.distance * (1.0f - kShadowRayShortening)};
}

/// A point on a surface that asks for light, with both its normals on the lit side; unit.
struct LitPoint {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;
  glm::vec3 geometric_normal_ws;
};

/// Share of the samples of emissive surfaces that follow the cosine instead of the sources' power.
/// Power alone is best for far lamps, but a point near an emitter then gets rare, enormous samples:
/// the mixed density bounds them by pi / kCosineShare times the radiance.
inline constexpr float kCosineShare = 0.1f;

/// Where an emissive triangle was found, and with which density.
struct EmitterPoint {
  glm::vec3 to_light{0.0f};  ///< Unit.
  float distance = 0.0f;     ///< [m]
  glm::vec3 radiance{0.0f};  ///< [W/(m^2 sr)]; 0: nothing was found.
  float pdf_power = 0.0f;    ///< With which sampling by power finds it [1/sr].
};

/// A point drawn from the emissive triangles by power; `u` are three uniform numbers.
EmitterPoint sample_emitter_by_power(const World& world, const glm::vec3& position_ws,
                                     const glm::vec3& u);

/// The emissive triangle that a ray about the normal, drawn by the cosine, meets first, if any.
EmitterPoint sample_emitter_by_cosine(const World& world, const LitPoint& point, const vec2& u);

/// Calls visit(LightCandidate) for every directional, point and spot light that reaches the point
/// unoccluded, and for `emissive_samples` points of emissive triangles, whose expected sum is what
/// these send. Emitters are drawn by power or by cosine and weighted by both densities (balance
/// heuristic of one sample: Veach 1997, sec. 9.2.4).
template <class Visit>
void for_each_light(const World& world, const LitPoint& point, int emissive_samples,
                    RandomStream& random, Visit visit) {
  for (const Light& light : world.scene().lights) {
    const PunctualSample sample = sample_punctual(light, point.position_ws);
    if (sample.irradiance == glm::vec3(0.0f)) continue;
    visit(LightCandidate{sample.to_light, sample.distance, sample.irradiance});
  }
  if (world.emissive().empty()) return;
  const float share = 1.0f / static_cast<float>(emissive_samples);
  for (int i = 0; i < emissive_samples; ++i) {
    const bool by_cosine = next_uniform(random) < kCosineShare;
    // Stratify the choice of the triangle over the samples
    const float u = (static_cast<float>(i) + next_uniform(random)) * share;
    const vec2 v = next_uniform2(random);
    const EmitterPoint emitter =
        by_cosine ? sample_emitter_by_cosine(world, point, v)
                  : sample_emitter_by_power(world, point.position_ws, {u, v.x, v.y});
    if (emitter.radiance == glm::vec3(0.0f)) continue;
    const float pdf_cosine = pdf_cosine_hemisphere(glm::dot(point.normal_ws, emitter.to_light));
    const float pdf = glm::mix(emitter.pdf_power, pdf_cosine, kCosineShare);
    visit(LightCandidate{emitter.to_light, emitter.distance, emitter.radiance * (share / pdf)});
  }
}

}  // namespace lambent
