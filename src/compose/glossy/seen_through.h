// SPDX-License-Identifier: Apache-2.0
// What pixels see through their surfaces, and how it is filtered: on the first surface behind that
// lets no light through, and again where rough glass blurs what is behind it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "compose/layers.h"
#include "lambent/denoise.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"

namespace lambent {

/// Light that comes through the surfaces of a band's pixels.
struct TransmittedLight {
  std::vector<glm::vec3> light;  ///< Without what is kept apart to be filtered [W/(m^2 sr)].
  std::vector<float> distances;  ///< As of distance_met [m].
  /// What coats of the first surfaces behind glass reflect of emitters and by rays [W/(m^2 sr)],
  /// and the distances to what these rays met [m]. They are kept apart where light is filtered.
  std::vector<glm::vec3> coats_behind;
  std::vector<float> coat_distances;

  bool empty() const { return light.empty(); }
  void clear() { light.clear(); }
};

/// One sample of the pixels of the traced rows. Its memory is used again.
struct SeenThrough {
  // The first surface on a pixel's way that lets no light through, and light of emitters there
  std::vector<float> depths;  ///< Distance from the camera to it [m]; 0: there is none.
  std::vector<glm::vec3> positions_ws, normals_ws;
  std::vector<glm::vec3> emitters;
  std::vector<float> emitter_variance, emitter_levels;
  std::vector<glm::vec3> emitter_albedo;  ///< What comes through of filtered light.
  // Light that its coat reflects
  std::vector<glm::vec3> coats, coat_albedo, coat_to_viewer_ws;
  std::vector<float> coat_alphas;
  std::vector<float> coat_distances;  ///< To what it sees [m]; below 0 where it has no lobe.

  // All light that comes through, without the tint of the pixel's own surface
  std::vector<glm::vec3> light;
  std::vector<glm::vec3> albedo;  ///< What comes to the camera of it.
  // The lobes that rough surfaces blur it with, as those of coats that face the other way
  std::vector<glm::vec3> away_normals_ws, to_viewer_ws;
  std::vector<float> alphas;     ///< 0: what is seen is sharp.
  std::vector<float> distances;  ///< To what they show [m]; below 0 where there are none.

  std::vector<float> inverse_distances, coat_inverse_distances;  ///< As of seen_inverse_distance.
  std::vector<glm::vec3> filtered_emitters, filtered_coats, filtered;

  /// Makes room for the rows' pixels, which see nothing through their surfaces yet.
  void start(std::size_t pixels, const FrameSettings& settings);
  /// Has nothing filtered or shown, in scenes that let no light through.
  void clear();
};

/// Where a band keeps light of the first surfaces behind glass, so that it can be filtered.
struct KeptBehind {
  SeenThrough* seen = nullptr;  ///< Null: that light is part of all that comes through.
  std::size_t first = 0;        ///< The band's first pixel among the traced ones.
};

/// Whether light that comes through surfaces is filtered.
inline bool filters_through(const FrameRequest& request) {
  return request.settings.denoise && tracer_of(request.world).has_glass();
}

/// Whether glass may be rough, so that what it shows is filtered once more.
bool shows_rough_glass(const FrameRequest& request);

/// What a band's pixels see through their surfaces.
struct BandSeenThrough {
  const GBuffer& gbuffer;
  const TransmittedLight& transmitted;
  std::span<const glm::vec4> fog;  ///< As in struct BandToFilter.
  std::size_t first;               ///< Of the band, among the traced pixels.
};

/// Keeps a band's light; that of emitters stands in `seen` already.
void keep_through(const BandSeenThrough& band, SeenThrough& seen);

/// Filters what was kept, into `seen.filtered`. `view`: what the pixels show.
void filter_through(const DenoiseView& view, Denoiser& denoiser, SeenThrough& seen);

/// Adds filtered light to the layers of the rows that are shown, with this weight.
void show_through(const SeenThrough& seen, const ShownPixels& shown, float share, Layers& layers);

}  // namespace lambent
