// SPDX-License-Identifier: Apache-2.0
#include "compose/gbuffer.h"

#include "compose/check_frame.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "lambent/field.h"
#include "lambent/renderer.h"
#include "raytracing/camera_rays.h"
#include "raytracing/ray_cone.h"
#include "raytracing/world_access.h"
#include "scene/environment_sampling.h"

namespace lambent {

glm::vec2 sample_position(const FrameSettings& settings, int x, int y, int sample, uint jitter) {
  return vec2(x, y) + subpixel_position(static_cast<uint>(sample),
                                        static_cast<uint>(settings.samples), settings.seed, jitter);
}

void trace_gbuffer(const World& world, const Camera& camera, const FrameSettings& settings,
                   const Band& band, int sample, GBuffer& gbuffer, uint jitter) {
  const int width = settings.width;
  const std::size_t pixels = static_cast<std::size_t>(band.rows) * width;
  gbuffer.hits.resize(pixels);
  gbuffer.surfaces.resize(pixels);
  gbuffer.hit.resize(pixels);
  gbuffer.to_viewer_ws.resize(pixels);

  const CameraRecord record = camera_record(camera, width, settings.height);
  parallel_chunks(band.rows, 1, [&](std::size_t begin, std::size_t) {
    const int row = band.first_row + static_cast<int>(begin);
    std::vector<Ray> rays(width);
    const std::span<Hit> hits =
        std::span(gbuffer.hits).subspan(begin * static_cast<std::size_t>(width), width);
    for (int x = 0; x < width; ++x) {
      const CameraRay ray = camera_ray(record, sample_position(settings, x, row, sample, jitter));
      rays[x] = {ray.origin_ws, 0.0f, ray.direction_ws};
      rays[x].mask = sample_mask(
          static_cast<uint>(row * width + x),
          sample_number(static_cast<uint>(sample), static_cast<uint>(settings.samples), jitter),
          static_cast<uint>(settings.samples), settings.seed);
    }
    tracer_of(world).closest_hits(rays, hits);
    prefetch_surfaces(world.scene(), hits);
    for (int x = 0; x < width; ++x) {
      const std::size_t i = begin * width + x;
      gbuffer.to_viewer_ws[i] = -rays[x].direction;
      gbuffer.hit[i] = hits[x].missed() ? 0 : 1;
      const RayCone cone =
          camera_cone(record, rays[x].direction, static_cast<uint>(settings.samples), jitter);
      if (hits[x].missed()) {
        gbuffer.surfaces[i].emission =
            sky_radiance_in_cone(sky_of(world), rays[x].direction, cone.spread);
        continue;
      }
      gbuffer.surfaces[i] =
          seen_surface_at(world.scene(), rays[x], hits[x], width_at(cone, hits[x].distance));
      Surface& surface = gbuffer.surfaces[i];
      if (world.scene().materials[surface.material].unlit) {
        surface.emission *= settings.unlit_radiance;
      }
    }
  });
}

Expected<std::vector<FieldQuery>> visible_points(const World& world, const Camera& camera,
                                                 int width, int height) {
  if (const Expected<void> fine = check_view(camera, width, height); !fine) {
    return tl::unexpected(fine.error());
  }
  FrameSettings settings;
  settings.width = width;
  settings.height = height;
  GBuffer gbuffer;
  trace_gbuffer(world, camera, settings, {0, height}, 0, gbuffer);
  std::vector<FieldQuery> points;
  for (std::size_t i = 0; i < gbuffer.hit.size(); ++i) {
    if (gbuffer.hit[i] == 0) continue;
    const Surface& surface = gbuffer.surfaces[i];
    points.push_back({surface.position_ws, surface.normal_ws, gbuffer.to_viewer_ws[i]});
  }
  return points;
}

}  // namespace lambent
