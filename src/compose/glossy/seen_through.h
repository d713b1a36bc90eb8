// SPDX-License-Identifier: Apache-2.0
// Light seen through surfaces, and its filtering: on the first opaque surface behind, and again
// where rough glass blurs what is behind it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gather/shown_gather.h"
#include "compose/gbuffer.h"
#include "compose/layers.h"
#include "lambent/denoise.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"

namespace lambent {

/// Light transmitted through the surfaces of a band's pixels.
struct TransmittedLight {
  std::vector<glm::vec3> light;  ///< Without the light that is filtered separately [W/(m^2 sr)].
  std::vector<float> distances;  ///< See distance_met() [m].
  /// Light that the coats of the first opaque surfaces behind glass reflect, of emitters and from
  /// rays [W/(m^2 sr)], and the distances to the hits of these rays [m]. Separate where light is
  /// filtered.
  std::vector<glm::vec3> coats_behind;
  std::vector<float> coat_distances;
  std::vector<glm::vec3> long_ways;  ///< Light of long ways, see kStageLongWay [W/(m^2 sr)].
  /// The first opaque surfaces behind glass; empty where these gather no light.
  std::vector<ShownBase> bases;

  bool empty() const { return light.empty(); }
  void clear() {
    light.clear();
    bases.clear();
  }
};

/// One sample of the pixels of the traced rows. Its memory is reused.
struct SeenThrough {
  // The first opaque surface on a pixel's path, and the light of emitters there
  std::vector<float> depths;  ///< Distance from the camera to it [m]; 0: there is none.
  std::vector<glm::vec3> positions_ws, normals_ws;
  std::vector<glm::vec3> emitters;
  std::vector<float> emitter_variance, emitter_levels;
  std::vector<glm::vec3> emitter_albedo;  ///< Factor from filtered light to `light`.
  ShownGatherPixels gather;               ///< Empty where these surfaces gather no light.
  // The light that this surface's coat reflects
  std::vector<glm::vec3> coats, coat_albedo, coat_to_viewer_ws;
  std::vector<float> coat_alphas;
  std::vector<float> coat_distances;  ///< To what it reflects [m]; below 0 where it has no lobe.

  // All transmitted light, divided by the tint of the pixel's own surface
  std::vector<glm::vec3> light;
  std::vector<glm::vec3> albedo;  ///< Factor from that light to the camera's radiance.
  /// Light of long ways, divided likewise: single bright rays, which are spread over the glass.
  /// Empty: it is part of `light`.
  std::vector<glm::vec3> long_ways;
  std::vector<float> glass_depths;  ///< Of the pixel's own surface [m]; 0 where it is not glass.
  // The lobes over which rough surfaces blur it, as lobes of coats that face away from the camera
  std::vector<glm::vec3> away_normals_ws, to_viewer_ws;
  std::vector<float> alphas;     ///< 0: the transmitted image is sharp.
  std::vector<float> distances;  ///< To what is seen [m]; below 0 where there is no lobe.

  std::vector<float> inverse_distances, coat_inverse_distances;  ///< See seen_inverse_distance().
  std::vector<glm::vec3> filtered_emitters, filtered_coats, filtered_long_ways, filtered;

  /// Makes room for the traced rows' pixels. Those of a band, from index `first` on, show no
  /// transmitted light yet; those that it skips keep theirs for their neighbours, and add none.
  void start(const FrameRequest& request, std::size_t pixels, const GBuffer& gbuffer,
             std::size_t first);
  /// Empties all arrays, for scenes without transmission.
  void clear();
};

/// Where a band stores the light of the first opaque surfaces behind glass, to be filtered.
struct KeptBehind {
  SeenThrough* seen = nullptr;  ///< Null: that light is part of the other transmitted light.
  std::size_t first = 0;        ///< First pixel of the band among the traced ones.
};

/// Whether transmitted light is filtered.
inline bool filters_through(const FrameRequest& request) {
  return request.settings.denoise && tracer_of(request.world).has_glass();
}

/// Whether the first opaque surfaces behind glass gather their indirect light by rays of their own.
inline bool gathers_behind_glass(const FrameRequest& request) {
  return gathers_shown(request) && filters_through(request);
}

/// Whether light that has come a long way through glass is filtered: that of volumes, within which
/// it is reflected.
bool filters_long_ways(const FrameRequest& request);

/// The settings that it is filtered with.
DenoiseSettings long_way_denoising();

/// Whether some surface of the scene may spread the light that it transmits.
bool has_rough_glass(const Scene& scene);

/// Whether the scene may have rough glass, so that transmitted light is filtered a second time.
bool shows_rough_glass(const FrameRequest& request);

/// Transmitted light of a band's pixels.
struct BandSeenThrough {
  const GBuffer& gbuffer;
  const TransmittedLight& transmitted;
  const ShownGather* gathered;     ///< Null: surfaces behind glass gather no light.
  std::span<const glm::vec4> fog;  ///< See BandToFilter.
  std::size_t first;               ///< First pixel of the band among the traced ones.
};

/// Stores a band's light; `seen` already holds that of emitters.
void keep_through(const BandSeenThrough& band, SeenThrough& seen);

/// Filters the stored light into `seen.filtered`. `view`: the surfaces that the pixels show.
void filter_through(const DenoiseView& view, Denoiser& denoiser, SeenThrough& seen);

/// Adds the filtered light, times `share`, to the layers of the rows that are shown.
void show_through(const SeenThrough& seen, const ShownPixels& shown, float share, Layers& layers);

}  // namespace lambent
