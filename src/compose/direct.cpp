// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "compose/gbuffer.h"
#include "core/parallel.h"
#include "raytracing/direct_light.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 1024;

/// What a pixel gains if a shadow ray arrives.
struct PendingLight {
  std::size_t pixel;
  ReflectedPair light;
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
      const LitPoint point{surface.position_ws, surface.normal_ws, surface.geometric_normal_ws};
      for_each_light(
          world, point, settings.emissive_samples, random, [&](const LightCandidate& candidate) {
            const ReflectedPair pair =
                unoccluded_reflection(surface.reflectance, frame, to_viewer, point, candidate);
            if (pair.diffuse + pair.specular == vec3(0.0f)) return;
            pending.push_back({i, pair});
            shadows.push_back(shadow_ray(point.position_ws, point.geometric_normal_ws, candidate));
          });
    }
    std::vector<std::uint8_t> occluded(shadows.size());
    tracer_of(world).occlusions(shadows, occluded);
    for (std::size_t k = 0; k < pending.size(); ++k) {
      if (occluded[k] != 0) continue;
      light.diffuse[pending[k].pixel] += pending[k].light.diffuse;
      light.specular[pending[k].pixel] += pending[k].light.specular;
    }
    rays += shadows.size();
  });
  return rays;
}

}  // namespace lambent
