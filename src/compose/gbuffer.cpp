// SPDX-License-Identifier: Apache-2.0
#include "compose/gbuffer.h"

#include <atomic>

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
namespace {

/// A pixel without a sample.
void show_nothing(GBuffer& gbuffer, std::size_t pixel) {
  gbuffer.hits[pixel] = {};
  gbuffer.hits[pixel].sample_weight = 0.0f;
  gbuffer.surfaces[pixel] = {};
  gbuffer.hit[pixel] = 0;
  gbuffer.to_viewer_ws[pixel] = vec3(0.0f);
}

}  // namespace

glm::vec2 sample_position(const FrameSettings& settings, int x, int y, int sample, uint jitter) {
  return vec2(x, y) + subpixel_position(static_cast<uint>(sample),
                                        static_cast<uint>(settings.samples), settings.seed, jitter);
}

std::uint64_t trace_gbuffer(const World& world, const Camera& camera, const FrameSettings& settings,
                            const Band& band, int sample, GBuffer& gbuffer, uint jitter,
                            const SampleRound& round) {
  const int width = settings.width;
  const std::size_t pixels = static_cast<std::size_t>(band.rows) * width;
  gbuffer.skipped = {};
  if (!round.skipped.empty()) {
    const std::size_t before = static_cast<std::size_t>(band.first_row) * width;
    gbuffer.skipped = round.skipped.subspan(before, pixels);
  }
  gbuffer.hits.resize(pixels);
  gbuffer.surfaces.resize(pixels);
  gbuffer.hit.resize(pixels);
  gbuffer.to_viewer_ws.resize(pixels);

  const CameraRecord record = camera_record(camera, width, settings.height);
  const auto round_first = static_cast<uint>(round.first);
  const uint sample_in_round = static_cast<uint>(sample) - round_first;
  const uint samples_of_round = static_cast<uint>(settings.samples) - round_first;
  std::atomic<std::uint64_t> traced = 0;
  parallel_chunks(band.rows, 1, [&](std::size_t begin, std::size_t) {
    const int row = band.first_row + static_cast<int>(begin);
    std::vector<Ray> rays;
    std::vector<std::size_t> sampled;  // the rays' pixels
    for (int x = 0; x < width; ++x) {
      const std::size_t i = begin * width + x;
      if (gbuffer.skips(i)) {
        show_nothing(gbuffer, i);
        continue;
      }
      const CameraRay ray = camera_ray(record, sample_position(settings, x, row, sample, jitter));
      const uint mask = sample_mask(static_cast<uint>(row * width + x),
                                    sample_number(sample_in_round, samples_of_round, jitter),
                                    samples_of_round, round_seed(settings.seed, round_first));
      rays.push_back({ray.origin_ws, 0.0f, ray.direction_ws});
      rays.back().mask = mask;
      sampled.push_back(i);
    }
    std::vector<Hit> hits(rays.size());
    tracer_of(world).closest_hits(rays, hits);
    prefetch_surfaces(world.scene(), hits);
    traced += rays.size();
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::size_t i = sampled[k];
      gbuffer.hits[i] = hits[k];
      gbuffer.to_viewer_ws[i] = -rays[k].direction;
      gbuffer.hit[i] = hits[k].missed() ? 0 : 1;
      const RayCone cone =
          camera_cone(record, rays[k].direction, static_cast<uint>(settings.samples), jitter);
      if (hits[k].missed()) {
        gbuffer.surfaces[i].emission =
            sky_radiance_in_cone(sky_of(world), rays[k].direction, cone.spread);
        continue;
      }
      gbuffer.surfaces[i] =
          seen_surface_at(world.scene(), rays[k], hits[k], width_at(cone, hits[k].distance));
      Surface& surface = gbuffer.surfaces[i];
      if (world.scene().materials[surface.material].unlit) {
        surface.emission *= settings.unlit_radiance;
      }
    }
  });
  return traced;
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
