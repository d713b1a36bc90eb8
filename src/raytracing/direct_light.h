// SPDX-License-Identifier: Apache-2.0
// Light that sources send straight to a point: one candidate a light, and some points of the
// emissive triangles.
#pragma once

#include "lambent/world.h"
#include "raytracing/emitter_sampling.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"
#include "shared/brdf.h"
#include "shared/rays.h"

namespace lambent {

/// The ray that asks whether a candidate reaches a point; the geometric normal is on the lit side.
inline Ray shadow_ray(const glm::vec3& position_ws, const glm::vec3& geometric_normal_ws,
                      const LightCandidate& light) {
  const RayRecord ray = shadow_ray_record(position_ws, geometric_normal_ws, light);
  return {ray.origin_ws, ray.t_min, ray.direction_ws, ray.t_max, ray.mask};
}

/// A point on a surface that asks for light, with both its normals on the lit side; unit.
struct LitPoint {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;
  glm::vec3 geometric_normal_ws;
};

/// What a point's candidates are drawn from.
struct LightDraws {
  const World& world;
  int emissive_samples;  ///< Points of emissive triangles, >= 1.
};

// What direct_light.inl.h asks for.
using LitPointRef = const LitPoint&;
using DrawsRef = const LightDraws&;

inline uint light_count(const LightDraws& draws) {
  return static_cast<uint>(draws.world.scene().lights.size());
}
inline LightRecord fetch_light(const LightDraws& draws, uint light) {
  return light_record(draws.world.scene().lights[light]);
}
inline uint emitter_samples(const LightDraws& draws) {
  return emissive_of(draws.world).empty() ? 0u : static_cast<uint>(draws.emissive_samples);
}
inline EmissiveSample fetch_emissive_sample(const LightDraws& draws, const vec3& u) {
  return emissive_of(draws.world).sample(u);
}
/// Traces a ray off the point's surface, and finds the emissive triangle that it meets first, if
/// any.
EmitterPoint find_emitter(const LightDraws& draws, const LitPoint& point, uint sample_index,
                          const vec3& direction);

#include "raytracing/direct_light.inl.h"

/// Calls visit(LightCandidate) for every directional, point and spot light that reaches the point
/// unoccluded, and for `emissive_samples` points of emissive triangles, whose expected sum is what
/// these send.
template <class Visit>
void for_each_light(const World& world, const LitPoint& point, int emissive_samples,
                    RandomStream& random, Visit visit) {
  const LightDraws draws{world, emissive_samples};
  const uint slots = slot_count(draws);
  for (uint slot = 0; slot < slots; ++slot) {
    const LightCandidate light = candidate_of_slot(draws, point, slot, random);
    if (light.perpendicular_irradiance != vec3(0.0f)) visit(light);
  }
}

}  // namespace lambent
