// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "compose/gbuffer.h"
#include "core/parallel.h"
#include "raytracing/direct_light.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 1024;

/// A shadow ray's stake: what the pixel gains if it arrives.
struct PendingLight {
  std::size_t pixel;
  vec3 diffuse;
  vec3 specular;
};

}  // namespace

std::uint64_t shade_direct(const World& world, const GBuffer& gbuffer,
                           const FrameSettings& settings, const Band& band, int sample,
                           ReflectedLight& light) {
  light.diffuse.assign(gbuffer.size(), vec3(0.0f));
  light.specular.assign(gbuffer.size(), vec3(0.0f));
  const std::size_t first_pixel = static_cast<std::size_t>(band.first_row) * settings.width;
  std::atomic<std::uint64_t> rays = 0;

  parallel_chunks(gbuffer.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> shadows;
    std::vector<PendingLight> pending;
    for (std::size_t i = begin; i < end; ++i) {
      if (gbuffer.hit[i] == 0) continue;
      const Surface& surface = gbuffer.surfaces[i];
      const Frame frame = make_frame(surface.normal_ws);
      const vec3 to_viewer = to_local(frame, gbuffer.to_viewer_ws[i]);
      RandomStream random = make_random_stream(static_cast<uint>(first_pixel + i),
                                               static_cast<uint>(sample), settings.seed);
      for_each_light(world, {surface.position_ws, surface.normal_ws, surface.geometric_normal_ws},
                     settings.emissive_samples, random, [&](const LightCandidate& candidate) {
                       if (dot(surface.geometric_normal_ws, candidate.to_light) <= 0.0f) return;
                       const vec3 to_light = to_local(frame, candidate.to_light);
                       const ReflectedPair share =
                           evaluate_reflectance(surface.reflectance, to_viewer, to_light);
                       if (share.diffuse == vec3(0.0f) && share.specular == vec3(0.0f)) return;
                       pending.push_back({i, share.diffuse * candidate.perpendicular_irradiance,
                                          share.specular * candidate.perpendicular_irradiance});
                       shadows.push_back(
                           shadow_ray(surface.position_ws, surface.geometric_normal_ws, candidate));
                     });
    }
    std::vector<std::uint8_t> occluded(shadows.size());
    tracer_of(world).occlusions(shadows, occluded);
    for (std::size_t k = 0; k < pending.size(); ++k) {
      if (occluded[k] != 0) continue;
      light.diffuse[pending[k].pixel] += pending[k].diffuse;
      light.specular[pending[k].pixel] += pending[k].specular;
    }
    rays += shadows.size();
  });
  return rays;
}

}  // namespace lambent
