// SPDX-License-Identifier: Apache-2.0
// A lookup interpolates between probes, so that light and shade finer than their spacing is lost:
// an occluder near a surface, but not near a probe, does not darken it. A gather replaces the last
// bounce of the lookup by rays and takes the other bounces from the field. Ward, Rubinstein and
// Clear, "A Ray Tracing Solution for Diffuse Interreflection", SIGGRAPH 1988; Jensen, "Global
// Illumination using Photon Maps", 1996, sec. 5 (the field in place of the photon map).
#include "gather/gather.h"

#include <atomic>

#include "core/parallel.h"
#include "field/field_access.h"
#include "field/lookup/query_at.h"
#include "field/probes/volumes.h"
#include "gather/gather_math.h"
#include "raytracing/shade_hits.h"
#include "raytracing/world_access.h"
#include "shared/rays.h"
#include "shared/variance.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 256;

/// The volumes of a field.
struct FieldVolumes {
  std::span<const ProbeGrid> grids;

  const ProbeGrid& fetch_grid(int volume) const { return grids[static_cast<std::size_t>(volume)]; }
#include "field/lookup/spacing.inl.h"
};

/// What gathers read.
struct GatherSources {
  const World& world;
  const IrradianceField& field;
  std::vector<ProbeGrid> grids;
  ShadeHitsSettings shading;
};

/// Rays, the shading of their hits, and the field's irradiance there [W/m^2].
struct GatheringRays {
  std::vector<Ray> rays;
  std::vector<std::size_t> indices;  // among all rays of the picture
  std::vector<ShadedHit> shaded;
  std::vector<vec3> from_field;

  /// Traces the rays and computes the direct light at their hits; returns the number of rays
  /// traced.
  std::uint64_t trace(const GatherSources& from, std::uint32_t salt, ShadeHitsScratch& scratch) {
    std::vector<Hit> hits(rays.size());
    shaded.resize(rays.size());
    tracer_of(from.world).closest_hits(rays, hits);
    ShadeHitsSettings shading = from.shading;
    shading.salt = salt;
    return rays.size() + shade_hits(from.world, rays, hits, shading, indices, scratch, shaded);
  }

  /// Looks up the field where hits reflect its light, but for the hits `skipped`, in rising order.
  void look_up(const GatherSources& from, std::span<const std::size_t> skipped) {
    std::vector<FieldQuery> queries;
    std::vector<std::size_t> asking;
    std::size_t next = 0;  // of the skipped hits
    for (std::size_t i = 0; i < shaded.size(); ++i) {
      const bool skips = next < skipped.size() && skipped[next] == i;
      if (skips) ++next;
      if (skips || !reads_field(shaded[i].surface)) continue;
      queries.push_back(query_at(shaded[i].point));
      asking.push_back(i);
    }
    std::vector<vec3> answers(queries.size());
    look_up_irradiance(from.field, queries, CorrectionUse::picked, answers, from.world);
    from_field.resize(shaded.size(), vec3(0.0f));
    for (std::size_t k = 0; k < asking.size(); ++k) from_field[asking[k]] = answers[k];
  }
};

/// A run of pixels. Those that show a surface gather light.
class GatherChunk {
 public:
  GatherChunk(const GatherRequest& request, std::size_t begin, std::size_t end)
      : request_(request), rays_per_pixel_(static_cast<std::size_t>(request.rays_per_pixel)) {
    for (std::size_t i = begin; i < end; ++i) {
      if (request.seen[i] != 0) add_rays(i);
    }
  }

  /// Computes what the rays gather; returns the number of rays traced.
  std::uint64_t trace(const GatherSources& from) { return trace(from, first_, 0); }

  /// Sums up each pixel's rays.
  void sum(GatheredLight& light) const {
    const std::span<const vec3> known = request_.known;
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      const Surface& surface = request_.surfaces[pixels_[p]];
      const vec3& geometric_normal_ws = surface.geometric_normal_ws;
      const float above =
          above_horizon(surface.gi_share, dot(surface.normal_ws, geometric_normal_ws));
      vec3 sum(0.0f), excess(0.0f);
      float luminances = 0.0f, squares = 0.0f;
      for (std::size_t r = p * rays_per_pixel_; r < (p + 1) * rays_per_pixel_; ++r) {
        const vec3 brought = gathered_irradiance(
            above, geometric_normal_ws, first_.rays[r].direction, first_.shaded[r].surface,
            first_.shaded[r].direct_irradiance, first_.from_field[r]);
        const vec3 kept = known.empty() ? brought : kept_of_ray(brought, known[pixels_[p]]);
        const float level = luminance(kept);
        sum += kept;
        excess += brought - kept;
        luminances += level;
        squares += level * level;
      }
      const float share = 1.0f / static_cast<float>(rays_per_pixel_);
      light.irradiance[pixels_[p]] = share * sum;
      if (!known.empty()) light.excess[pixels_[p]] = share * excess;
      if (light.variance.empty()) continue;
      light.variance[pixels_[p]] =
          share * share * variance_of_sum(luminances, squares, static_cast<uint>(rays_per_pixel_));
    }
  }

 private:
  void add_rays(std::size_t pixel) {
    pixels_.push_back(pixel);
    const Surface& surface = request_.surfaces[pixel];
    const Frame frame = make_frame(surface.normal_ws);
    const vec3 origin = offset_ray_origin(surface.position_ws, surface.geometric_normal_ws);
    const auto width = static_cast<std::size_t>(request_.width);
    const auto x = static_cast<uint>(pixel % width);
    const auto y = static_cast<uint>(pixel / width) + static_cast<uint>(request_.first_row);
    const std::size_t place = static_cast<std::size_t>(request_.first_row) * width + pixel;
    const auto count = static_cast<uint>(rays_per_pixel_);
    for (uint ray = 0; ray < count; ++ray) {
      const vec2 point = pixel_point(x, y, ray, count, request_.sample, request_.seed);
      first_.rays.push_back(
          {origin, 0.0f, gather_direction(frame, point), kInfiniteDistance, kRayGathers});
      first_.indices.push_back(place * rays_per_pixel_ + ray);
    }
  }

  /// Finds the light that the rays of a depth (see gather_salt()) bring. Returns the number of rays
  /// traced.
  std::uint64_t trace(const GatherSources& from, GatheringRays& rays, int depth) {
    if (rays.rays.empty()) return 0;
    std::uint64_t traced = rays.trace(from, gather_salt(request_.sample, depth), scratch_);
    GatheringRays following;
    std::vector<std::size_t> parents;  // hits from which the following rays start
    if (depth < kMaxSecondaryRays) {
      parents = add_secondary_rays(from, rays, depth + 1, following);
      traced += trace(from, following, depth + 1);
    }
    rays.look_up(from, parents);
    for (std::size_t k = 0; k < parents.size(); ++k) {
      const LitPoint& point = rays.shaded[parents[k]].point;
      rays.from_field[parents[k]] =
          secondary_irradiance(point.normal_ws, point.geometric_normal_ws,
                               following.rays[k].direction, following.shaded[k].surface,
                               following.shaded[k].direct_irradiance, following.from_field[k]);
    }
    return traced;
  }

  /// Adds the secondary gathers of a depth at the hits of the rays of the depth before. Returns
  /// these hits in rising order.
  std::vector<std::size_t> add_secondary_rays(const GatherSources& from, const GatheringRays& rays,
                                              int depth, GatheringRays& following) const {
    std::vector<std::size_t> parents;
    FieldVolumes volumes{from.grids};
    const int count = static_cast<int>(from.grids.size());
    for (std::size_t i = 0; i < rays.rays.size(); ++i) {
      if (!reads_field(rays.shaded[i].surface)) continue;
      const LitPoint& point = rays.shaded[i].point;
      const SecondaryRay drawn = secondary_ray(
          point.position_ws, point.normal_ws, point.geometric_normal_ws,
          min(point.viewer_distance, rays.shaded[i].light_distance),
          volumes.spacing_at(count, point.position_ws), static_cast<uint>(rays.indices[i]),
          gather_salt(request_.sample, depth), request_.seed);
      if (!drawn.traced) continue;
      parents.push_back(i);
      following.rays.push_back(
          {drawn.origin_ws, 0.0f, drawn.direction_ws, kInfiniteDistance, kRayGathers});
      following.indices.push_back(rays.indices[i]);
    }
    return parents;
  }

  const GatherRequest& request_;
  std::size_t rays_per_pixel_;
  std::vector<std::size_t> pixels_;
  GatheringRays first_;
  ShadeHitsScratch scratch_;
};

}  // namespace

std::uint64_t gather_irradiance(const World& world, const IrradianceField& field,
                                const GatherRequest& request, GatheredLight& light) {
  light.irradiance.assign(request.seen.size(), vec3(0.0f));
  light.excess.assign(request.known.empty() ? 0 : request.seen.size(), vec3(0.0f));
  light.variance.assign(request.rays_per_pixel > 1 ? request.seen.size() : 0, 0.0f);
  GatherSources from{world, field, still_grids(field.grids()), {}};
  ShadeHitsSettings& shading = from.shading;
  shading.cone_width = kHemisphereConeWidth / sqrt(static_cast<float>(request.rays_per_pixel));
  shading.max_albedo = field.settings().max_albedo;
  shading.seed = request.seed;
  shading.candidates = kSecondaryCandidates;
  shading.follow_mirrors = true;
  std::atomic<std::uint64_t> traced = 0;
  parallel_chunks(request.seen.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    GatherChunk chunk(request, begin, end);
    traced += chunk.trace(from);
    chunk.sum(light);
  });
  return traced;
}

}  // namespace lambent
