// SPDX-License-Identifier: Apache-2.0
// The surfaces that mirrors show, and which of their light is filtered.
#include <algorithm>

#include "compose/frame_tasks.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/pixel_math.h"
#include "core/parallel.h"

namespace lambent {

/// Stores the surfaces that pixels' mirrors show, with the light of emitters there. Elsewhere, that
/// joins the other direct light.
void Glossy::keep_mirrored_bases() {
  const bool emitters = !direct_.emitters.empty();
  if (!emitters && !gathers_in_mirrors_) return;
  parallel_chunks(met_.size(), kCostlyPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (met_.hit[i] == 0) continue;
      const Surface& surface = met_.surfaces[i];
      const CoatPath& path = paths_.paths[i];
      if (emitters) direct_.specular[i] += direct_.emitter_specular[i];
      if (!is_in_own_mirror(path, surface.transmission, surface.reflectance)) {
        if (emitters) direct_.diffuse[i] += direct_.emitters[i];
        continue;
      }
      ShownBase& base = mirrored_bases_[i];
      base = shown_base(surface.position_ws, surface.normal_ws, surface.geometric_normal_ws,
                        surface.gi_share, surface.reflectance, met_.to_viewer_ws[i],
                        distance(surface.position_ws, paths_.next[i].origin), path,
                        gathers_in_mirrors_);
      if (!emitters) continue;
      const float variance = direct_.emitter_variance.empty() ? 0.0f : direct_.emitter_variance[i];
      add_emitters(
          filtered_emitter(surface.reflectance, direct_.emitters[i], direct_.unoccluded[i]),
          variance, path, base);
    }
  });
}

bool filters_mirrored_light(const FrameRequest& request) {
  if (!request.settings.denoise || !traces_coats(request)) return false;
  return std::ranges::any_of(request.world.scene().materials, [](const Material& material) {
    const bool textured = material.metallic_roughness_texture.texture >= 0;
    return !material.lambert &&
           (textured || material.roughness * material.roughness <= kMirrorAlpha);
  });
}

bool gathers_in_mirrors(const FrameRequest& request) {
  return gathers_shown(request) && filters_mirrored_light(request);
}

}  // namespace lambent
