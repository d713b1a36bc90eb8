// SPDX-License-Identifier: Apache-2.0
// Reflections of clearcoats on the processor: those of coats, once more, with the clearcoats in
// their place.
#include "compose/glossy/glossy_frame.h"
#include "core/parallel.h"

namespace lambent {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

}  // namespace

void show_clearcoats(GBuffer& pixels) {
  parallel_chunks(pixels.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (pixels.hit[i] == 0) continue;
      Surface& surface = pixels.surfaces[i];
      surface.normal_ws = clearcoat_normal_ws(surface.reflectance.layers, surface.normal_ws);
      surface.reflectance = clearcoat_alone(surface.reflectance.layers);
    }
  });
}

std::uint64_t reflect_clearcoats(const FrameRequest& request, const Band& band, int sample,
                                 const GBuffer& pixels, GlossyMemory& memory,
                                 std::vector<glm::vec3>& light) {
  light.clear();
  bool any = false;
  for (std::size_t i = 0; i < pixels.size() && !any; ++i) {
    any = pixels.hit[i] != 0 && has_clearcoat(pixels.surfaces[i].reflectance.layers);
  }
  if (!any) return 0;
  GBuffer& coats = memory.clearcoats;
  coats = pixels;
  show_clearcoats(coats);
  if (traces_coats(request)) find_coat_shares(coats);
  const std::uint64_t rays = reflect_band(request, band, sample, CoatKind::clearcoat, coats, memory,
                                          memory.clearcoat_rays);
  look_up_coats(request, coats, memory.clearcoat_rays, memory, memory.clearcoat_irradiance);
  light.assign(pixels.size(), vec3(0.0f));
  parallel_chunks(pixels.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (coats.hit[i] == 0) continue;
      const Surface& coat = coats.surfaces[i];
      light[i] =
          coat_light(coat.reflectance, dot(coat.normal_ws, coats.to_viewer_ws[i]), coat.gi_share,
                     memory.clearcoat_rays.empty() ? vec4(0.0f) : memory.clearcoat_rays.light[i],
                     memory.clearcoat_irradiance[i]);
    }
  });
  return rays;
}

}  // namespace lambent
