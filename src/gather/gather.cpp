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
#include "gather/gather_math.h"
#include "raytracing/shade_hits.h"
#include "raytracing/world_access.h"
#include "shared/rays.h"
#include "shared/variance.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 256;

/// A run of pixels. Those that show a surface gather light.
class GatherChunk {
 public:
  GatherChunk(const World& world, const GatherRequest& request, std::size_t begin, std::size_t end)
      : world_(world),
        request_(request),
        rays_per_pixel_(static_cast<std::size_t>(request.rays_per_pixel)),
        first_pixel_(static_cast<std::size_t>(request.first_row) * request.width) {
    for (std::size_t i = begin; i < end; ++i) {
      if (request.seen[i] != 0) add_rays(i);
    }
  }

  /// Traces the rays and computes the direct light at their hits; returns the number of rays
  /// traced.
  std::uint64_t trace(const ShadeHitsSettings& shading) {
    std::uint64_t traced = rays_.size();
    std::vector<Hit> hits(rays_.size());
    shaded_.resize(rays_.size());
    tracer_of(world_).closest_hits(rays_, hits);
    // Shade runs of neighbouring pixels together
    for (std::size_t first = 0, end_of_run; first < pixels_.size(); first = end_of_run) {
      end_of_run = first + 1;
      while (end_of_run < pixels_.size() && pixels_[end_of_run] == pixels_[end_of_run - 1] + 1) {
        ++end_of_run;
      }
      const std::size_t at = first * rays_per_pixel_,
                        count = (end_of_run - first) * rays_per_pixel_;
      traced += shade_hits(world_, std::span(rays_).subspan(at, count),
                           std::span(hits).subspan(at, count), shading,
                           (first_pixel_ + pixels_[first]) * rays_per_pixel_, scratch_,
                           std::span(shaded_).subspan(at, count));
    }
    return traced;
  }

  /// Adds the field's light at the hits, and sums up each pixel's rays.
  void light(const IrradianceField& field, GatheredLight& light) const {
    std::vector<FieldQuery> queries(rays_.size());
    std::vector<vec3> from_field(rays_.size());
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      queries[i] = query_at(shaded_[i].point);
    }
    look_up_irradiance(field, queries, CorrectionUse::picked, from_field, world_);
    const std::span<const vec3> known = request_.known;
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      const Surface& surface = request_.surfaces[pixels_[p]];
      const vec3& geometric_normal_ws = surface.geometric_normal_ws;
      const float above =
          above_horizon(surface.gi_share, dot(surface.normal_ws, geometric_normal_ws));
      vec3 sum(0.0f), excess(0.0f);
      float luminances = 0.0f, squares = 0.0f;
      for (std::size_t r = p * rays_per_pixel_; r < (p + 1) * rays_per_pixel_; ++r) {
        // A bent normal's hemisphere reaches below the surface, from where no light comes
        if (dot(geometric_normal_ws, rays_[r].direction) <= 0.0f) continue;
        // Rays are drawn in proportion to the cosine: irradiance is pi times their mean radiance
        const vec3 brought =
            (kPi * above) *
            gathered_radiance(shaded_[r].surface, shaded_[r].direct_irradiance, from_field[r]);
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
    const auto count = static_cast<uint>(rays_per_pixel_);
    for (uint ray = 0; ray < count; ++ray) {
      const vec2 point = pixel_point(x, y, ray, count, request_.sample, request_.seed);
      rays_.push_back(
          {origin, 0.0f, gather_direction(frame, point), kInfiniteDistance, kRayGathers});
    }
  }

  const World& world_;
  const GatherRequest& request_;
  std::size_t rays_per_pixel_, first_pixel_;
  std::vector<std::size_t> pixels_;
  std::vector<Ray> rays_;
  std::vector<ShadedHit> shaded_;
  ShadeHitsScratch scratch_;
};

}  // namespace

std::uint64_t gather_irradiance(const World& world, const IrradianceField& field,
                                const GatherRequest& request, GatheredLight& light) {
  light.irradiance.assign(request.seen.size(), vec3(0.0f));
  light.excess.assign(request.known.empty() ? 0 : request.seen.size(), vec3(0.0f));
  light.variance.assign(request.rays_per_pixel > 1 ? request.seen.size() : 0, 0.0f);
  ShadeHitsSettings shading;
  shading.cone_width = kHemisphereConeWidth / sqrt(static_cast<float>(request.rays_per_pixel));
  shading.max_albedo = field.settings().max_albedo;
  shading.salt = request.sample;
  shading.seed = request.seed;
  shading.candidates = kGatherCandidates;
  shading.follow_mirrors = true;
  std::atomic<std::uint64_t> traced = 0;
  parallel_chunks(request.seen.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    GatherChunk chunk(world, request, begin, end);
    traced += chunk.trace(shading);
    chunk.light(field, light);
  });
  return traced;
}

}  // namespace lambent
