// SPDX-License-Identifier: Apache-2.0
#include "field/surfels.h"

#include <atomic>
#include <cassert>

#include "core/parallel.h"
#include "raytracing/direct_light.h"
#include "raytracing/surface.h"
#include "scene/environment_sampling.h"
#include "shared/packing.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 8;

/// A shadow ray's stake: what the surfel gains if it arrives.
struct PendingLight {
  std::size_t surfel;
  vec3 irradiance;
};

/// The share of light that a surface sends back, as if it did so evenly: its Lambert base and its
/// coat's directional albedo, so that metals pass light on, too.
vec3 effective_albedo(const Reflectance& reflectance, float n_dot_v, float max_albedo) {
  vec3 albedo = reflectance.diffuse;
  if (reflectance.f90 > 0.0f) {
    const vec3 specular = specular_albedo(reflectance, n_dot_v);
    albedo = albedo * (vec3(1.0f) - reflectance.f0) + specular;
  }
  return min(albedo, vec3(max_albedo));
}

}  // namespace

std::size_t Surfels::bytes() const {
  return size() * (5 * sizeof(vec3) + sizeof(uint) + 1 + sizeof(SurfelLookup));
}

void Surfels::resize(std::size_t probes, int rays) {
  rays_per_probe = rays;
  const std::size_t count = probes * rays;
  position_ws.resize(count);
  normal_ws.resize(count);
  albedo_over_pi.resize(count);
  emission.resize(count);
  direct_irradiance.resize(count);
  sky_radiance.resize(count);
  counts.resize(count);
  lookups.resize(count);
}

void trace_probe_rays(const RayTracer& tracer, const ProbeGrid& grid,
                      std::span<const vec3> directions, std::vector<Hit>& hits) {
  const std::size_t probes = static_cast<std::size_t>(grid.count.x) * grid.count.y * grid.count.z;
  const std::size_t rays = directions.size();
  hits.resize(probes * rays);
  parallel_chunks(probes, kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> batch(rays);
    for (std::size_t probe = begin; probe < end; ++probe) {
      const vec3 origin = probe_position(grid, probe_coords(grid, static_cast<int>(probe)));
      for (std::size_t i = 0; i < rays; ++i) batch[i] = {origin, 0.0f, directions[i]};
      tracer.closest_hits(batch, {&hits[probe * rays], rays});
    }
  });
}

std::uint64_t shade_surfels(const World& world, const ProbeGrid& grid,
                            std::span<const vec3> directions, std::span<const Hit> hits,
                            const FieldSettings& settings, uint update, Surfels& surfels) {
  const std::size_t rays = directions.size();
  const std::size_t probes = hits.size() / rays;
  surfels.resize(probes, static_cast<int>(rays));
  const Scene& scene = world.scene();
  std::atomic<std::uint64_t> shadow_rays = 0;

  // Width of the cone that stands for one ray, per metre: that of its share of the sphere.
  const float cone_width =
      2.0f * sqrt(4.0f / static_cast<float>(rays)) * exp2(settings.texture_lod_bias);

  parallel_chunks(probes, kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> shadows;
    std::vector<PendingLight> pending;
    for (std::size_t probe = begin; probe < end; ++probe) {
      const vec3 origin = probe_position(grid, probe_coords(grid, static_cast<int>(probe)));
      for (std::size_t i = 0; i < rays; ++i) {
        const std::size_t s = probe * rays + i;
        surfels.emission[s] = 0u;
        surfels.albedo_over_pi[s] = vec3(0.0f);
        surfels.direct_irradiance[s] = vec3(0.0f);
        surfels.sky_radiance[s] = vec3(0.0f);
        surfels.counts[s] = 1;
        surfels.normal_ws[s] = -directions[i];
        if (hits[s].missed()) {
          surfels.position_ws[s] = origin;
          surfels.sky_radiance[s] = sky_radiance(scene.environment, directions[i]);
          continue;
        }

        // Record the surface
        const Ray ray{origin, 0.0f, directions[i]};
        const Surface surface = surface_at(scene, ray, hits[s], cone_width * hits[s].distance);
        surfels.position_ws[s] = surface.position_ws;
        surfels.normal_ws[s] = surface.normal_ws;
        if (!surface.front_face && !surface.double_sided) {
          surfels.counts[s] = 0;
          continue;
        }
        surfels.emission[s] = encode_rgb9e5(surface.emission, vec3(0.5f));
        const vec3 albedo = effective_albedo(
            surface.reflectance, -dot(surface.normal_ws, directions[i]), settings.max_albedo);
        surfels.albedo_over_pi[s] = albedo * kInvPi;
        if (albedo == vec3(0.0f)) continue;

        // Ask for the light that may reach it
        RandomStream random = make_random_stream(static_cast<uint>(s), update, settings.seed);
        for_each_light(world, surface.position_ws, settings.emissive_samples, random,
                       [&](const LightCandidate& light) {
                         const float cosine = dot(surface.normal_ws, light.to_light);
                         const float side = dot(surface.geometric_normal_ws, light.to_light);
                         if (cosine <= 0.0f || side <= 0.0f) return;
                         pending.push_back({s, light.perpendicular_irradiance * cosine});
                         shadows.push_back(
                             shadow_ray(surface.position_ws, surface.geometric_normal_ws, light));
                       });
      }
    }

    // Add the light that does reach
    std::vector<std::uint8_t> occluded(shadows.size());
    world.tracer().occlusions(shadows, occluded);
    for (std::size_t i = 0; i < pending.size(); ++i) {
      if (occluded[i] == 0) surfels.direct_irradiance[pending[i].surfel] += pending[i].irradiance;
    }
    shadow_rays += shadows.size();
  });
  return shadow_rays;
}

void find_surfel_lookups(const ProbeStore& store, std::span<const vec3> directions,
                         Surfels& surfels) {
  const std::size_t rays = directions.size();
  const int texels = store.irradiance_texels();
  parallel_chunks(surfels.size() / rays, kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<FieldQuery> queries;
    std::vector<std::size_t> reflecting;
    for (std::size_t s = begin * rays; s < end * rays; ++s) {
      // What reflects nothing does not ask what lights it
      if (surfels.albedo_over_pi[s] == vec3(0.0f)) continue;
      reflecting.push_back(s);
      queries.push_back({surfels.position_ws[s], surfels.normal_ws[s], -directions[s % rays]});
    }
    std::vector<CornerWeights> weights(queries.size());
    corner_weights(store, queries, weights);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const TileFetch fetch = tile_fetch(queries[i].normal_ws, texels);
      surfels.lookups[reflecting[i]] = {
          weights[i], static_cast<std::uint32_t>(fetch.corner.x + (texels + 1) * fetch.corner.y),
          fetch.fraction.x, fetch.fraction.y};
    }
  });
}

}  // namespace lambent
