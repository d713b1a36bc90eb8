// SPDX-License-Identifier: Apache-2.0
// Reflections of clearcoats on the processor: the passes of coats run again, with the clearcoats in
// their place.
#include <algorithm>

#include "compose/frame_tasks.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"
#include "scene/transmission.h"

namespace lambent {
namespace {}  // namespace

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

bool filters_clearcoats(const FrameRequest& request) {
  if (!request.settings.denoise || !traces_coats(request)) return false;
  const std::vector<Material>& materials = request.world.scene().materials;
  return std::any_of(materials.begin(), materials.end(), [](const Material& material) {
    return has_layers(material) && material.clearcoat > 0.0f &&
           is_filtered_clearcoat(material.clearcoat_roughness * material.clearcoat_roughness);
  });
}

std::uint64_t reflect_clearcoats(const FrameRequest& request, const Band& band, int sample,
                                 const GBuffer& pixels, std::span<const glm::vec3> sky,
                                 GlossyMemory& memory, std::vector<glm::vec3>& light) {
  light.clear();
  bool any = false;
  for (std::size_t i = 0; i < pixels.size() && !any; ++i) {
    any = pixels.hit[i] != 0 && has_clearcoat(pixels.surfaces[i].reflectance.layers);
  }
  if (!any) return 0;
  GBuffer& coats = memory.clearcoats.surfaces;
  CoatLight& by_rays = memory.clearcoats.rays;
  coats = pixels;
  show_clearcoats(coats);
  if (traces_coats(request)) find_coat_shares(coats);
  const std::uint64_t rays =
      reflect_band(request, band, sample, CoatKind::clearcoat, coats, sky, memory, by_rays);
  look_up_coats(request, coats, by_rays, memory, memory.clearcoat_irradiance);
  const bool filters = filters_clearcoats(request);
  light.assign(pixels.size(), vec3(0.0f));
  parallel_chunks(pixels.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (coats.hit[i] == 0) continue;
      const Surface& coat = coats.surfaces[i];
      vec4 brought = by_rays.empty() ? vec4(0.0f) : by_rays.light[i];
      if (filters && is_filtered_clearcoat(coat.reflectance.alpha)) {
        brought = vec4(vec3(0.0f), brought.w);
      }
      light[i] = coat_light(coat.reflectance, dot(coat.normal_ws, coats.to_viewer_ws[i]),
                            coat.gi_share, brought, memory.clearcoat_irradiance[i]);
    }
  });
  return rays;
}

}  // namespace lambent
