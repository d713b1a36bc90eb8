// SPDX-License-Identifier: Apache-2.0
// Final gathering: indirect light of a pixel from rays of its own, whose hits the irradiance field
// lights.
//
// A lookup interpolates between probes, so light and shade finer than their spacing is lost: what
// is close to a surface but not to a probe does not darken it. A gather replaces the last bounce of
// the lookup by rays and leaves the others to the field. Ward, Rubinstein and Clear, "A Ray Tracing
// Solution for Diffuse Interreflection", SIGGRAPH 1988; Jensen, "Global Illumination using Photon
// Maps", 1996, sec. 5 (the field in place of the photon map).
#include <atomic>

#include "compose/gbuffer.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "lambent/field.h"
#include "raytracing/shade_hits.h"
#include "raytracing/world_access.h"
#include "shared/rays.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 256;

/// Rays of one pixel.
void gather_rays(const Surface& surface, int count, const vec2& shift, std::vector<Ray>& rays) {
  const Frame frame = make_frame(surface.normal_ws);
  const vec3 origin = offset_ray_origin(surface.position_ws, surface.geometric_normal_ws);
  for (int i = 0; i < count; ++i) {
    rays.push_back({origin, 0.0f, gather_direction(frame, shift, static_cast<uint>(i)),
                    kInfiniteDistance, kRayGathers});
  }
}

}  // namespace

std::uint64_t gather_irradiance(const World& world, const IrradianceField& field,
                                const GBuffer& gbuffer, const FrameSettings& settings,
                                const Band& band, int sample, std::vector<glm::vec3>& irradiance) {
  irradiance.assign(gbuffer.size(), vec3(0.0f));
  const std::size_t first_pixel = static_cast<std::size_t>(band.first_row) * settings.width;
  const auto rays_per_pixel = static_cast<std::size_t>(settings.gather_rays);
  std::atomic<std::uint64_t> traced = 0;

  ShadeHitsSettings shading;
  shading.cone_width = kHemisphereConeWidth / sqrt(static_cast<float>(rays_per_pixel));
  shading.max_albedo = field.settings().max_albedo;
  shading.back_faces_count = true;
  shading.salt = static_cast<uint>(sample);
  shading.seed = settings.seed;

  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    // Trace the rays of the pixels that show a surface, and light what they meet directly
    std::vector<std::size_t> pixels;
    std::vector<Ray> rays;
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      pixels.push_back(i);
      gather_rays(gbuffer.surfaces[i], settings.gather_rays,
                  gather_shift(static_cast<uint>(first_pixel + i), static_cast<uint>(sample),
                               settings.seed),
                  rays);
    }
    std::vector<Hit> hits(rays.size());
    std::vector<ShadedHit> shaded(rays.size());
    ShadeHitsScratch scratch;
    tracer_of(world).closest_hits(rays, hits);
    // Runs of pixels that all show a surface are shaded together
    for (std::size_t first = 0, end_of_run; first < pixels.size(); first = end_of_run) {
      end_of_run = first + 1;
      while (end_of_run < pixels.size() && pixels[end_of_run] == pixels[end_of_run - 1] + 1) {
        ++end_of_run;
      }
      const std::size_t at = first * rays_per_pixel, count = (end_of_run - first) * rays_per_pixel;
      traced +=
          shade_hits(world, std::span(rays).subspan(at, count), std::span(hits).subspan(at, count),
                     shading, (first_pixel + pixels[first]) * rays_per_pixel, scratch,
                     std::span(shaded).subspan(at, count));
    }
    traced += rays.size();

    // Light it by the field
    std::vector<FieldQuery> queries(rays.size());
    std::vector<vec3> from_field(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      queries[i] = {shaded[i].point.position_ws, shaded[i].point.normal_ws, -rays[i].direction};
    }
    field.irradiance(queries, from_field, &world);

    // Rays are drawn in proportion to the cosine: irradiance is pi times their mean radiance
    const float weight = kPi / static_cast<float>(rays_per_pixel);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      // A bent normal's hemisphere reaches below the surface, where no light comes from
      const std::size_t pixel = pixels[i / rays_per_pixel];
      const vec3 geometric_normal_ws = gbuffer.surfaces[pixel].geometric_normal_ws;
      if (dot(geometric_normal_ws, rays[i].direction) <= 0.0f) continue;
      irradiance[pixel] +=
          weight * gathered_radiance(shaded[i].surface, shaded[i].direct_irradiance, from_field[i]);
    }
  });
  return traced;
}

}  // namespace lambent
