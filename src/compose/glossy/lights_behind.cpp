// SPDX-License-Identifier: Apache-2.0
// Samples of the lights behind rough surfaces, on the processor.
#include <atomic>

#include "compose/frame_tasks.h"
#include "compose/glossy/glossy_frame.h"
#include "core/parallel.h"
#include "raytracing/direct_light.h"
#include "raytracing/glass/sky_behind.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

/// Light that arrives at a pixel's path if a shadow ray is unoccluded.
struct PendingLight {
  std::size_t pixel;
  vec3 light;
};

/// The shadow ray from behind a surface, which stops where light does not go straight on: rays find
/// what is farther.
Ray ray_behind(const Surface& surface, const LightCandidate& light) {
  Ray ray = shadow_ray(surface.position_ws, -surface.geometric_normal_ws, light);
  ray.mask = kRayThroughPanes;
  return ray;
}

/// Draws the candidates behind a surface, and queues their shadow rays.
void queue_lights_behind(const LightDraws& draws, const Media& media, const Surface& surface,
                         const vec3& to_viewer_ws, std::size_t pixel, RandomStream random,
                         std::vector<Ray>& shadows, std::vector<PendingLight>& pending) {
  const Frame frame = make_frame(surface.normal_ws);
  const Transmitter transmitter{surface.transmission, surface.reflectance, frame,
                                to_local(frame, to_viewer_ws), surface.geometric_normal_ws};
  const float density_scale =
      emitter_density_scale(draws.world, draws.tree_samples, surface.position_ws);
  const ThroughReceiver through{transmitter, density_scale};
  const LightReceiver receiver{
      {surface.position_ws, -surface.normal_ws, -surface.geometric_normal_ws},
      nullptr,
      nullptr,
      &through};
  const auto queue = [&](const LightCandidate& light, const vec3& transmitted) {
    if (transmitted == vec3(0.0f)) return;
    pending.push_back({pixel, transmitted});
    shadows.push_back(ray_behind(surface, light));
  };
  for_each_light(draws, receiver, random, [&](const LightCandidate& light) {
    vec3 transmitted = sampled_transmission(transmitter, light, density_scale);
    // Rays see no fog, and nor do samples of what they find, too
    if (light.emission_luminance <= 0.0f && !media.empty()) {
      transmitted *= transmittance(media, surface.position_ws, light.to_light, light.distance);
    }
    queue(light, transmitted);
  });
  const SkyBehind sky = sample_sky_behind(sky_of(draws.world), transmitter, random);
  queue({sky.direction_ws, infinity(), vec3(1.0f), 0.0f}, sky.light);
}

}  // namespace

std::uint64_t Glossy::sample_lights_behind(const GlossySettings& settings, const GBuffer& seen,
                                           std::uint32_t bounce) {
  const LightDraws draws{settings.world, settings.frame.reflected_emissive_samples};
  const Media media(settings.world.scene().fog);
  const uint first_index = static_cast<uint>(first_row_) * static_cast<uint>(settings.frame.width);
  std::atomic<std::uint64_t> traced = 0;
  parallel_chunks(seen.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> shadows;
    std::vector<PendingLight> pending;
    for (std::size_t i = begin; i < end; ++i) {
      if (seen.hit[i] == 0) continue;
      const Surface& surface = seen.surfaces[i];
      const bool samples =
          bounce == 0 ? lambent::samples_lights_behind(surface.transmission)
                      : lambent::samples_lights_behind(paths_.paths[i], surface.transmission);
      if (!samples) continue;
      const RandomStream random =
          make_random_stream(first_index + static_cast<uint>(i),
                             coat_salt(salt_, bounce) ^ kBehindSalt, settings.frame.seed);
      queue_lights_behind(draws, media, surface, seen.to_viewer_ws[i], i, random, shadows, pending);
    }
    ShadowRays arriving;
    arriving.trace(tracer_of(settings.world), shadows);
    for (std::size_t k = 0; k < pending.size(); ++k) {
      const vec3 light = arriving.share(k) * pending[k].light;
      const vec3 throughput = bounce == 0 ? vec3(1.0f) : paths_.paths[pending[k].pixel].throughput;
      rays_[pending[k].pixel].radiance += throughput * light;
    }
    traced += shadows.size();
  });
  return traced;
}

}  // namespace lambent
