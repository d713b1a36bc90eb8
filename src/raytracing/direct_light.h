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

/// Calls visit(LightCandidate) for every directional, point and spot light that reaches the point
/// unoccluded, and for `emissive_samples` points drawn from the emissive triangles, whose expected
/// sum is what these send.
template <class Visit>
void for_each_light(const World& world, const glm::vec3& position_ws, int emissive_samples,
                    RandomStream& random, Visit visit) {
  for (const Light& light : world.scene().lights) {
    const PunctualSample sample = sample_punctual(light, position_ws);
    if (sample.irradiance == glm::vec3(0.0f)) continue;
    visit(LightCandidate{sample.to_light, sample.distance, sample.irradiance});
  }
  if (world.emissive().empty()) return;
  const float share = 1.0f / static_cast<float>(emissive_samples);
  for (int i = 0; i < emissive_samples; ++i) {
    // Stratify the choice of the triangle over the samples
    const float u = (static_cast<float>(i) + next_uniform(random)) * share;
    const vec2 v = next_uniform2(random);
    const EmissiveSample sample = world.emissive().sample({u, v.x, v.y});
    const glm::vec3 offset = sample.position_ws - position_ws;
    const float squared = glm::dot(offset, offset);
    if (sample.pdf_area <= 0.0f || squared <= 0.0f) continue;
    const float distance = std::sqrt(squared);
    const glm::vec3 to_light = offset / distance;
    const float cosine = std::fabs(glm::dot(sample.normal_ws, to_light));
    visit(LightCandidate{to_light, distance,
                         sample.radiance * (share * cosine / (squared * sample.pdf_area))});
  }
}

}  // namespace lambent
