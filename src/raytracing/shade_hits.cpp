// SPDX-License-Identifier: Apache-2.0
#include "raytracing/shade_hits.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "core/simd.h"
#include "raytracing/mirrors/mirror_math.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "scene/environment_sampling.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// Kernels are inlined as a whole: their formulas pass large records by value.
#define LAMBENT_SHADING_KERNEL LAMBENT_SIMD_CLONES __attribute__((flatten))

/// Draws the candidates of direct light at points and queues their shadow rays.
LAMBENT_SHADING_KERNEL void queue_direct_light(const World& world,
                                               std::span<const DirectLightQuery> queries,
                                               const ShadeHitsSettings& settings,
                                               ShadeHitsScratch& scratch) {
  scratch.light_distances.assign(queries.size(), kInfiniteDistance);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const std::size_t place = i;
    float& nearest = scratch.light_distances[i];
    const DirectLightQuery& query = queries[i];
    const LitPoint& point = query.point;
    RandomStream random =
        make_random_stream(static_cast<std::uint32_t>(query.index), settings.salt, settings.seed);
    const LightDraws draws{world, settings.emissive_samples, false, settings.candidates};
    const SeenShape shape = seen_shape(point);
    const LightReceiver receiver{.point = point, .shape = shape};
    for_each_light(draws, receiver, random, [&](const LightCandidate& light) {
      const glm::vec3 irradiance = unoccluded_irradiance(point, shape, light);
      if (irradiance == glm::vec3(0.0f)) return;
      nearest = std::min(nearest, light.distance);
      scratch.pending.push_back({place, irradiance});
      scratch.shadow_rays.push_back(
          shadow_ray(point.position_ws, point.geometric_normal_ws, light));
    });
  }
}

/// Stores the part of a surface's shading that needs no light.
LAMBENT_SHADING_KERNEL void store_surface(const Surface& surface, const glm::vec3& direction,
                                          float distance, float max_albedo, uint from_inside,
                                          ShadedHit& result) {
  result.point = {surface.position_ws,
                  surface.normal_ws,
                  surface.geometric_normal_ws,
                  encode_albedo_shape(surface.reflectance),
                  -direction,
                  distance,
                  surface.reflectance.mean_normal_length};
  result.surface = shaded_surface(surface, direction, max_albedo, from_inside);
}

/// Finds the share of light that passes along rays which may cross glass.
void trace_transmittances(const RayTracer& tracer, std::span<const Ray> rays,
                          std::span<const Hit> hits, ShadeHitsScratch& scratch) {
  scratch.to_hits.assign(rays.begin(), rays.end());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    scratch.to_hits[i].t_max = before_hit(hits[i].distance);
  }
  scratch.through.resize(rays.size());
  tracer.transmittances(scratch.to_hits, scratch.through);
}

}  // namespace

std::size_t direct_irradiance(const World& world, std::span<const DirectLightQuery> queries,
                              const ShadeHitsSettings& settings, ShadeHitsScratch& scratch,
                              std::span<glm::vec3> irradiance) {
  assert(queries.size() == irradiance.size());
  scratch.shadow_rays.clear();
  scratch.pending.clear();
  std::fill(irradiance.begin(), irradiance.end(), glm::vec3(0.0f));
  queue_direct_light(world, queries, settings, scratch);
  // Add the light that arrives
  scratch.shadows.trace(tracer_of(world), scratch.shadow_rays);
  for (std::size_t i = 0; i < scratch.pending.size(); ++i) {
    const ShadeHitsScratch::PendingLight& light = scratch.pending[i];
    irradiance[light.query] += scratch.shadows.share(i) * light.irradiance;
  }
  return scratch.shadow_rays.size();
}

namespace {

/// Shades the hits of rays, whose numbers among all rays are `indices`. Returns the number of
/// shadow rays traced.
std::size_t shade_surfaces(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                           const ShadeHitsSettings& settings, std::span<const std::size_t> indices,
                           ShadeHitsScratch& scratch, std::span<ShadedHit> shaded) {
  const Scene& scene = world.scene();
  scratch.queries.clear();
  scratch.hits.clear();
  prefetch_surfaces(scene, hits);
  const bool glass = tracer_of(world).has_glass();
  if (glass) trace_transmittances(tracer_of(world), rays, hits, scratch);

  for (std::size_t i = 0; i < rays.size(); ++i) {
    ShadedHit& result = shaded[i];
    const glm::vec3& direction = rays[i].direction;
    result = {{rays[i].origin, -direction, -direction, 0u, -direction}, {}, glm::vec3(0.0f)};
    if (hits[i].missed()) {
      result.surface = shaded_sky(sky_radiance(scene.environment, direction));
      if (glass) {
        result.surface = seen_through_glass(result.surface, scratch.through[i], 1.0f, 1.0f);
      }
      continue;
    }

    // Store the surface
    const Surface surface =
        surface_at(scene, rays[i], hits[i], settings.cone_width * hits[i].distance);
    const bool from_inside =
        settings.solid_sides != nullptr && settings.solid_sides->is_solid(hits[i]);
    store_surface(surface, direction, hits[i].distance, settings.max_albedo, from_inside ? 1u : 0u,
                  result);

    if (glass) {
      // Rays that a pane stopped also stand for those that it let pass
      float weight = 1.0f;
      if (is_transmissive(surface.transmission) && crosses_glass(rays[i].mask)) {
        const SeenTriangle seen{hits[i].instance, hits[i].triangle, hits[i].barycentrics,
                                hits[i].front_face};
        weight = weight_of_stopped(straight_share_of(scene, seen, direction));
      }
      result.surface =
          seen_through_glass(result.surface, scratch.through[i], weight, settings.max_albedo);
    }

    // Queue points that reflect direct light
    if (result.surface.albedo_over_pi == glm::vec3(0.0f)) continue;
    scratch.queries.push_back({result.point, indices[i]});
    scratch.hits.push_back(i);
  }

  scratch.direct.resize(scratch.queries.size());
  const std::size_t shadow_rays =
      direct_irradiance(world, scratch.queries, settings, scratch, scratch.direct);
  for (std::size_t i = 0; i < scratch.hits.size(); ++i) {
    shaded[scratch.hits[i]].direct_irradiance = scratch.direct[i];
    shaded[scratch.hits[i]].light_distance = scratch.light_distances[i];
  }
  return shadow_rays;
}

/// Traces the rays that go on at mirrors, so far `mirrors` one after the other, and merges what
/// they find into the hits. Returns the number of rays traced, 0 where none goes on.
std::size_t follow_mirrors(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                           const ShadeHitsSettings& settings, std::span<const std::size_t> indices,
                           uint mirrors, ShadeHitsScratch& scratch, std::span<ShadedHit> shaded) {
  ShadeHitsScratch::Reflected& reflected = scratch.reflected;
  reflected.from.clear();
  reflected.rays.clear();
  reflected.indices.clear();
  const std::uint32_t salt = salt_of_mirror(settings.salt, mirrors);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const LitPoint& point = shaded[i].point;
    // Rays that met no mirror before have none behind it
    if (mirrors > 0 && shaded[i].surface.mirror_distance <= 0.0f) continue;
    if (!goes_on(shaded[i].surface, point.albedo_shape, point.normal_ws, point.to_viewer_ws)) {
      continue;
    }
    RandomStream random = make_random_stream(static_cast<uint>(indices[i]), salt, settings.seed);
    reflected.from.push_back(i);
    reflected.rays.push_back(
        {offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f,
         sample_mirror(point.albedo_shape, point.normal_ws, point.geometric_normal_ws,
                       point.to_viewer_ws, next_uniform2(random)),
         kInfiniteDistance, rays[i].mask});
    reflected.indices.push_back(indices[i]);
  }
  if (reflected.rays.empty()) return 0;

  // Shade what the mirrors show
  reflected.hits.resize(reflected.rays.size());
  reflected.shaded.resize(reflected.rays.size());
  tracer_of(world).closest_hits(reflected.rays, reflected.hits);
  ShadeHitsSettings behind = settings;
  behind.salt = salt_behind(settings.salt, mirrors + 1);
  const std::size_t shadow_rays = shade_surfaces(world, reflected.rays, reflected.hits, behind,
                                                 reflected.indices, scratch, reflected.shaded);
  for (std::size_t k = 0; k < reflected.from.size(); ++k) {
    const std::size_t i = reflected.from[k];
    const ShadedHit& shown = reflected.shaded[k];
    const LitHit both = shown_by_mirror({shaded[i].surface, shaded[i].direct_irradiance},
                                        {shown.surface, shown.direct_irradiance}, hits[i].distance);
    shaded[i] = {shown.point, both.hit, both.irradiance, shown.light_distance};
  }
  return reflected.rays.size() + shadow_rays;
}

}  // namespace

std::size_t shade_hits(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                       const ShadeHitsSettings& settings, std::span<const std::size_t> indices,
                       ShadeHitsScratch& scratch, std::span<ShadedHit> shaded) {
  assert(rays.size() == hits.size() && rays.size() == shaded.size() &&
         rays.size() == indices.size());
  std::size_t traced = shade_surfaces(world, rays, hits, settings, indices, scratch, shaded);
  if (!settings.follow_mirrors) return traced;
  for (uint mirrors = 0; mirrors < kMaxMirrors; ++mirrors) {
    const std::size_t followed =
        follow_mirrors(world, rays, hits, settings, indices, mirrors, scratch, shaded);
    if (followed == 0) break;
    traced += followed;
  }
  return traced;
}

std::size_t shade_hits(const World& world, std::span<const Ray> rays, std::span<const Hit> hits,
                       const ShadeHitsSettings& settings, std::size_t first_index,
                       ShadeHitsScratch& scratch, std::span<ShadedHit> shaded) {
  scratch.indices.resize(rays.size());
  std::iota(scratch.indices.begin(), scratch.indices.end(), first_index);
  return shade_hits(world, rays, hits, settings, scratch.indices, scratch, shaded);
}

}  // namespace lambent
