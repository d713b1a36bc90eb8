// SPDX-License-Identifier: Apache-2.0
#include "raytracing/shade_hits.h"

#include <cassert>

#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "scene/environment_sampling.h"

namespace lambent {
namespace {

/// Draws the candidates of direct light at a point and queues their shadow rays.
void queue_direct_light(const World& world, const DirectLightQuery& query, std::size_t place,
                        const ShadeHitsSettings& settings, ShadeHitsScratch& scratch) {
  const LitPoint& point = query.point;
  RandomStream random =
      make_random_stream(static_cast<std::uint32_t>(query.index), settings.salt, settings.seed);
  for_each_light(world, point, settings.emissive_samples, random, [&](const LightCandidate& light) {
    const glm::vec3 irradiance = unoccluded_irradiance(point, light);
    if (irradiance == glm::vec3(0.0f)) return;
    scratch.pending.push_back({place, irradiance});
    scratch.shadow_rays.push_back(shadow_ray(point.position_ws, point.geometric_normal_ws, light));
  });
}

}  // namespace

std::size_t direct_irradiance(const World& world, std::span<const DirectLightQuery> queries,
                              const ShadeHitsSettings& settings, ShadeHitsScratch& scratch,
                              std::span<glm::vec3> irradiance) {
  assert(queries.size() == irradiance.size());
  scratch.shadow_rays.clear();
  scratch.pending.clear();
  for (std::size_t i = 0; i < queries.size(); ++i) {
    irradiance[i] = glm::vec3(0.0f);
    queue_direct_light(world, queries[i], i, settings, scratch);
  }
  // Add the light that does reach
  scratch.occluded.resize(scratch.shadow_rays.size());
  tracer_of(world).occlusions(scratch.shadow_rays, scratch.occluded);
  for (std::size_t i = 0; i < scratch.pending.size(); ++i) {
    const ShadeHitsScratch::PendingLight& light = scratch.pending[i];
    if (scratch.occluded[i] == 0) irradiance[light.query] += light.irradiance;
  }
  return scratch.shadow_rays.size();
}

std::size_t shade_hits(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                       const ShadeHitsSettings& settings, std::size_t first_index,
                       ShadeHitsScratch& scratch, std::span<ShadedHit> shaded) {
  assert(rays.size() == hits.size() && rays.size() == shaded.size());
  const Scene& scene = world.scene();
  scratch.queries.clear();
  scratch.hits.clear();
  prefetch_surfaces(scene, hits);

  for (std::size_t i = 0; i < rays.size(); ++i) {
    ShadedHit& result = shaded[i];
    const glm::vec3& direction = rays[i].direction;
    result = {{rays[i].origin, -direction, -direction}, {}, glm::vec3(0.0f)};
    if (hits[i].missed()) {
      result.surface = shaded_sky(sky_radiance(scene.environment, direction));
      continue;
    }

    // Record the surface
    const Surface surface =
        surface_at(scene, rays[i], hits[i], settings.cone_width * hits[i].distance);
    result.point = {surface.position_ws, surface.normal_ws, surface.geometric_normal_ws};
    result.surface = shaded_surface(surface, direction, settings.max_albedo,
                                    settings.back_faces_count ? 1u : 0u);

    // Ask for the light that may reach it
    if (result.surface.albedo_over_pi == glm::vec3(0.0f)) continue;
    scratch.queries.push_back({result.point, first_index + i});
    scratch.hits.push_back(i);
  }

  scratch.direct.resize(scratch.queries.size());
  const std::size_t shadow_rays =
      direct_irradiance(world, scratch.queries, settings, scratch, scratch.direct);
  for (std::size_t i = 0; i < scratch.hits.size(); ++i) {
    shaded[scratch.hits[i]].direct_irradiance = scratch.direct[i];
  }
  return shadow_rays;
}

}  // namespace lambent
