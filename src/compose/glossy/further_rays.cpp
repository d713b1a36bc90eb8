// SPDX-License-Identifier: Apache-2.0
// Further rays of coats that no ray of a neighbouring pixel helps, on the processor.
#include <atomic>

#include "compose/frame_tasks.h"
#include "compose/glossy/glossy_frame.h"
#include "core/parallel.h"

namespace lambent {

/// Draws ray number `ray`, 1 or more, of pixels whose light is mostly that of their own ray.
/// Returns how many there are.
std::uint64_t Glossy::send_further_rays(const GlossySettings& settings, const GlossyRows& band,
                                        const CoatLight& light, uint ray) {
  const GBuffer& seen = band.pixels;
  start(settings, band.first_row, seen.size(), ray * kFurtherRaySalt);
  const auto width = static_cast<std::size_t>(settings.frame.width);
  std::atomic<std::uint64_t> sent = 0;
  parallel_chunks(seen.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    std::uint64_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (!needs_further_rays(light.own[i], seen.surfaces[i].reflectance.alpha)) continue;
      const uvec2 pixel(i % width, static_cast<std::size_t>(band.first_row) + i / width);
      const vec2 u = further_coat_uniforms(pixel, static_cast<uint>(settings.sample), ray,
                                           settings.frame.seed);
      if (draw_ray(settings, seen, i, u, i)) ++count;
    }
    sent += count;
  });
  return sent;
}

std::uint64_t Glossy::add_further_rays(const GlossySettings& settings, const GlossyRows& band,
                                       CoatLight& light) {
  const auto rays = static_cast<uint>(settings.frame.coat_rays);
  std::uint64_t traced = 0;
  for (uint ray = 1; ray < rays; ++ray) {
    const std::uint64_t going = send_further_rays(settings, band, light, ray);
    if (going == 0) break;
    traced += follow_all(settings, going, 1, {});
    const GBuffer& seen = band.pixels;
    parallel_chunks(seen.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (rays_[i].pdf == 0.0f) continue;
        const vec3 found = reflected_own_ray(receiver_of(settings, seen, i, rays_[i]));
        light.light[i] += vec4(further_light(light.own[i], found, rays), 0.0f);
      }
    });
  }
  return traced;
}

}  // namespace lambent
