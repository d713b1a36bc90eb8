// SPDX-License-Identifier: Apache-2.0
#include "field/surfels.h"

#include <atomic>

#include "core/parallel.h"
#include "shared/packing.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 8;

}  // namespace

std::size_t Surfels::bytes() const {
  return size() * (5 * sizeof(vec3) + sizeof(uint) + 1 + sizeof(SurfelLookup));
}

void Surfels::set(std::size_t surfel, const ShadedHit& hit) {
  position_ws[surfel] = hit.position_ws;
  normal_ws[surfel] = hit.normal_ws;
  albedo_over_pi[surfel] = hit.albedo_over_pi;
  emission[surfel] = encode_rgb9e5(hit.emission, vec3(0.5f));
  direct_irradiance[surfel] = hit.direct_irradiance;
  sky_radiance[surfel] = hit.sky_radiance;
  counts[surfel] = hit.counts ? 1 : 0;
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

ShadeHitsSettings surfel_shading(const FieldSettings& settings, uint update) {
  ShadeHitsSettings shading;
  // Width of the cone that stands for one ray, per metre: that of its share of the sphere.
  shading.cone_width = 2.0f * sqrt(4.0f / static_cast<float>(settings.rays_per_probe)) *
                       exp2(settings.texture_lod_bias);
  shading.max_albedo = settings.max_albedo;
  shading.emissive_samples = settings.emissive_samples;
  shading.salt = update;
  shading.seed = settings.seed;
  return shading;
}

std::uint64_t shade_surfels(const World& world, const ProbeGrid& grid,
                            std::span<const vec3> directions, std::span<const Hit> hits,
                            const FieldSettings& settings, uint update, Surfels& surfels) {
  const std::size_t rays = directions.size();
  const std::size_t probes = hits.size() / rays;
  surfels.resize(probes, static_cast<int>(rays));
  std::atomic<std::uint64_t> shadow_rays = 0;

  const ShadeHitsSettings shading = surfel_shading(settings, update);

  parallel_chunks(probes, kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> batch(rays);
    std::vector<ShadedHit> shaded(rays);
    ShadeHitsScratch scratch;
    for (std::size_t probe = begin; probe < end; ++probe) {
      const vec3 origin = probe_position(grid, probe_coords(grid, static_cast<int>(probe)));
      const std::size_t first = probe * rays;
      for (std::size_t i = 0; i < rays; ++i) batch[i] = {origin, 0.0f, directions[i]};
      shadow_rays +=
          shade_hits(world, batch, hits.subspan(first, rays), shading, first, scratch, shaded);
      for (std::size_t i = 0; i < rays; ++i) surfels.set(first + i, shaded[i]);
    }
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
    // Neighbouring probes' rays of one direction tend to end in the same cell: asked one after the
    // other, they find its probes in the cache
    for (std::size_t ray = 0; ray < rays; ++ray) {
      for (std::size_t probe = begin; probe < end; ++probe) {
        const std::size_t s = probe * rays + ray;
        // What reflects nothing does not ask what lights it
        if (surfels.albedo_over_pi[s] == vec3(0.0f)) continue;
        reflecting.push_back(s);
        queries.push_back({surfels.position_ws[s], surfels.normal_ws[s], -directions[ray]});
      }
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
