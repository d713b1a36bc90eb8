// SPDX-License-Identifier: Apache-2.0
// Rays on which paths continue, on the processor.
#pragma once

#include "compose/glossy/ray_reuse.h"
#include "glossy/path_math.h"
#include "raytracing/camera_rays.h"
#include "raytracing/direct_light.h"
#include "shared/rays.h"

namespace lambent {

/// The ray that leaves a surface.
inline Ray ray_from(const Surface& surface, const NextRay& next) {
  Ray ray;
  ray.origin = offset_ray_origin(surface.position_ws, next.side * surface.geometric_normal_ws);
  ray.direction = next.direction_ws;
  return ray;
}

/// emitter_density_scale() of a surface whose light is sampled for paths: one that they meet, or a
/// pixel's that they go through.
inline float reflected_density_scale(const GlossySettings& settings, const Surface& surface) {
  return emitter_density_scale(settings.world, settings.frame.reflected_emissive_samples,
                               surface.position_ws);
}

/// See pack_path_step().
inline uint path_step(const GlossySettings& settings, std::uint32_t bounce) {
  return pack_path_step(bounce, static_cast<uint>(settings.sample),
                        static_cast<uint>(settings.frame.samples - settings.first_of_round));
}

/// The cone of a pixel's primary ray at its hit.
inline RayCone pixel_cone(const GlossySettings& settings, const Surface& surface,
                          const vec3& to_viewer_ws) {
  RayCone cone = camera_cone(settings.camera, -to_viewer_ws,
                             static_cast<uint>(settings.frame.samples), settings.jitter);
  cone.width = width_at(cone, length(surface.position_ws - settings.camera.position_ws));
  return cone;
}

}  // namespace lambent
