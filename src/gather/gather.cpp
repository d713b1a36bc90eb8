// SPDX-License-Identifier: Apache-2.0
// A lookup interpolates between probes, so that light and shade finer than their spacing is lost:
// an occluder near a surface, but not near a probe, does not darken it. A gather replaces the last
// bounce of the lookup by rays and takes the other bounces from the field. Ward, Rubinstein and
// Clear, "A Ray Tracing Solution for Diffuse Interreflection", SIGGRAPH 1988; Jensen, "Global
// Illumination using Photon Maps", 1996, sec. 5 (the field in place of the photon map).
#include "gather/gather.h"

#include <atomic>

#include "core/parallel.h"
#include "field/probes/volumes.h"
#include "field/secondary/gathering_rays.h"
#include "gather/field_lighting.h"
#include "gather/gather_math.h"
#include "gather/guide.h"
#include "shared/rays.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 256;

/// The rays of pixels, guided where there is a guide.
struct GuidedRays {
  const GatherGuide* guide;  // null: none are guided

  const GuidePoint& fetch_guide_point(int point) const {
    return guide->points[static_cast<std::size_t>(point)];
  }
  const vec3& fetch_bright_place(int place) const {
    return guide->places[static_cast<std::size_t>(place)];
  }
#include "gather/guide.inl.h"
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
  std::uint64_t trace(const HitLighting& by) { return rays_.light(by, scratch_); }

  /// Sums up each pixel's rays.
  void sum(GatheredLight& light) const {
    const std::span<const vec3> known = request_.known;
    const auto count = static_cast<uint>(rays_per_pixel_);
    std::vector<vec3> brought(rays_per_pixel_);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      float total = 0.0f, most = 0.0f;
      bring(p, brought);
      for (const vec3& each : brought) {
        const float level = luminance(each);
        total += level;
        most = std::max(most, level);
      }
      const float level_known =
          known.empty() ? 0.0f : known_level(known[pixels_[p]], total, most, count);
      vec3 sum(0.0f), excess(0.0f);
      RaySums guided = {0.0f, 0.0f}, others = {0.0f, 0.0f};
      for (uint ray = 0; ray < count; ++ray) {
        const vec3 kept = known.empty() ? brought[ray] : kept_of_ray(brought[ray], level_known);
        sum += kept;
        excess += brought[ray] - kept;
        add_ray(ray < guided_[p] ? guided : others, luminance(kept));
      }
      const float share = 1.0f / static_cast<float>(rays_per_pixel_);
      light.irradiance[pixels_[p]] = share * sum;
      if (!known.empty()) light.excess[pixels_[p]] = share * excess;
      if (light.variance.empty()) continue;
      light.variance[pixels_[p]] =
          share * share * variance_of_rays(guided, others, guided_[p], count);
    }
  }

 private:
  /// What each of a pixel's rays contributes to its irradiance.
  void bring(std::size_t p, std::span<vec3> brought) const {
    const Surface& surface = request_.surfaces[pixels_[p]];
    const vec3& geometric_normal_ws = surface.geometric_normal_ws;
    const float above =
        above_horizon(surface.gi_share, dot(surface.normal_ws, geometric_normal_ws));
    for (std::size_t ray = 0; ray < brought.size(); ++ray) {
      const std::size_t r = p * rays_per_pixel_ + ray;
      brought[ray] =
          weights_[r] * gathered_irradiance(above, geometric_normal_ws, rays_.rays[r].direction,
                                            rays_.shaded[r].surface,
                                            rays_.shaded[r].direct_irradiance, rays_.arrives[r]);
    }
  }

  void add_rays(std::size_t pixel) {
    pixels_.push_back(pixel);
    const Surface& surface = request_.surfaces[pixel];
    const Frame frame = make_frame(surface.normal_ws);
    const vec3 origin = offset_ray_origin(surface.position_ws, surface.geometric_normal_ws);
    const auto width = static_cast<std::size_t>(request_.width);
    const auto count = static_cast<uint>(rays_per_pixel_);
    const GuidedRays::PixelRays rays = {
        static_cast<uint>(pixel % width),
        static_cast<uint>(pixel / width) + static_cast<uint>(request_.first_row), count,
        request_.sample, request_.seed};
    const std::size_t place = static_cast<std::size_t>(request_.first_row) * width + pixel;
    GuidedRays drawing{request_.guide};
    const int point = request_.guide == nullptr
                          ? -1
                          : drawing.guiding_point(request_.guide->size, rays, surface.normal_ws);
    const uint guided = point < 0 ? 0u : guided_rays(drawing.fetch_guide_point(point).share, count);
    guided_.push_back(guided);
    for (uint ray = 0; ray < count; ++ray) {
      const GuidedRays::GatherRay drawn =
          drawing.gather_ray(rays, ray, point, guided, surface.position_ws, frame);
      rays_.add(origin, drawn.direction_ws, place * rays_per_pixel_ + ray);
      weights_.push_back(drawn.weight);
    }
  }

  const GatherRequest& request_;
  std::size_t rays_per_pixel_;
  std::vector<std::size_t> pixels_;
  std::vector<uint> guided_;    // number of each pixel's guided rays, which are its first
  std::vector<float> weights_;  // of the rays' contributions
  GatheringRays rays_;
  ShadeHitsScratch scratch_;
};

}  // namespace

std::uint64_t gather_irradiance(const World& world, const IrradianceField& field,
                                const GatherRequest& request, GatheredLight& light) {
  light.irradiance.assign(request.seen.size(), vec3(0.0f));
  light.excess.assign(request.known.empty() ? 0 : request.seen.size(), vec3(0.0f));
  light.variance.assign(request.rays_per_pixel > 1 ? request.seen.size() : 0, 0.0f);
  const std::vector<ProbeGrid> grids = still_grids(field.grids());
  const HitLighting by =
      lit_by_field(world, field, grids,
                   gathering_shading(request.rays_per_pixel, field.settings().max_albedo,
                                     request.sample, request.seed),
                   kMaxSecondaryRays);
  std::atomic<std::uint64_t> traced = 0;
  parallel_chunks(request.seen.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    GatherChunk chunk(request, begin, end);
    traced += chunk.trace(by);
    chunk.sum(light);
  });
  return traced;
}

}  // namespace lambent
