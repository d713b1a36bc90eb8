// SPDX-License-Identifier: Apache-2.0
// Light that sources send straight to a point: one candidate a light, and some points of the
// emissive triangles.
#pragma once

#include <cmath>

#include "lambent/world.h"
#include "raytracing/emitter_sampling.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"
#include "shared/rays.h"

namespace lambent {

/// The ray that asks whether a candidate reaches a point; the geometric normal is on the lit side.
inline Ray shadow_ray(const glm::vec3& position_ws, const glm::vec3& geometric_normal_ws,
                      const LightCandidate& light) {
  return {offset_ray_origin(position_ws, geometric_normal_ws), 0.0f, light.to_light,
          shadow_ray_length(light.distance)};
}

/// A point on a surface that asks for light, with both its normals on the lit side; unit.
struct LitPoint {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;
  glm::vec3 geometric_normal_ws;
};

/// A point drawn from the emissive triangles by power; `u` are three uniform numbers.
EmitterPoint sample_emitter_by_power(const World& world, const glm::vec3& position_ws,
                                     const glm::vec3& u);

/// The emissive triangle that a ray about the normal, drawn by the cosine, meets first, if any.
EmitterPoint sample_emitter_by_cosine(const World& world, const LitPoint& point, const vec2& u);

/// Calls visit(LightCandidate) for every directional, point and spot light that reaches the point
/// unoccluded, and for `emissive_samples` points of emissive triangles, whose expected sum is what
/// these send.
template <class Visit>
void for_each_light(const World& world, const LitPoint& point, int emissive_samples,
                    RandomStream& random, Visit visit) {
  for (const Light& light : world.scene().lights) {
    const PunctualSample sample = sample_punctual(light, point.position_ws);
    if (sample.irradiance == glm::vec3(0.0f)) continue;
    visit(LightCandidate{sample.to_light, sample.distance, sample.irradiance});
  }
  if (emissive_of(world).empty()) return;
  const float share = 1.0f / static_cast<float>(emissive_samples);
  for (int i = 0; i < emissive_samples; ++i) {
    const EmitterDraw draw = draw_emitter(random, i, share);
    const EmitterPoint emitter =
        draw.by_cosine != 0 ? sample_emitter_by_cosine(world, point, vec2(draw.u.y, draw.u.z))
                            : sample_emitter_by_power(world, point.position_ws, draw.u);
    if (emitter.radiance == glm::vec3(0.0f)) continue;
    visit(emitter_candidate(emitter, point.normal_ws, share));
  }
}

}  // namespace lambent
