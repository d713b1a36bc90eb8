// SPDX-License-Identifier: Apache-2.0
// What pixels see through their surfaces, and how it is filtered: light of emitters on the first
// surface behind, as far as that is the same; and all light, as far as rough glass blurs it anyway.
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

/// One sample of the pixels of the traced rows. Its memory is used again.
struct SeenThrough {
  // Light of emitters on the first surface of a pixel's way that lets no light through
  std::vector<float> depths;  ///< Distance from the camera to it [m]; 0: there is none.
  std::vector<glm::vec3> positions_ws, normals_ws;
  std::vector<glm::vec3> emitters;
  std::vector<float> emitter_variance, emitter_levels;
  std::vector<glm::vec3> emitter_albedo;  ///< What comes through of filtered light.

  // All light that comes through, without the tint of the pixel's own surface
  std::vector<glm::vec3> light;
  std::vector<glm::vec3> albedo;  ///< What comes to the camera of it.
  // The lobes that rough surfaces blur it with, as those of coats that face the other way
  std::vector<glm::vec3> away_normals_ws, to_viewer_ws;
  std::vector<float> alphas;  ///< 0: what is seen is sharp.
  std::vector<float> inverse_distances;

  std::vector<glm::vec3> filtered_emitters, filtered;

  /// Makes room for the rows' pixels, which see nothing through their surfaces yet.
  void start(std::size_t pixels, const FrameSettings& settings);
  /// Ends all of it, where scenes let no light through.
  void clear();
};

/// Whether light that comes through surfaces is filtered.
inline bool filters_through(const FrameRequest& request) {
  return request.settings.denoise && tracer_of(request.world).has_glass();
}

/// What a band's pixels see through their surfaces.
struct BandSeenThrough {
  const GBuffer& gbuffer;
  std::span<const glm::vec3> light;  ///< As of Glossy::look_through.
  std::span<const float> distances;  ///< To what rays met first behind the surfaces [m].
  std::span<const glm::vec4> fog;    ///< As in struct BandToFilter.
  std::size_t first;                 ///< Of the band, among the traced pixels.
};

/// Keeps a band's light; that of emitters stands in `seen` already.
void keep_through(const BandSeenThrough& band, SeenThrough& seen);

/// Filters it, into `seen.filtered`. `view`: what the pixels show.
void filter_through(const DenoiseView& view, Denoiser& denoiser, SeenThrough& seen);

/// Adds it to the layers of the rows that are shown, with this weight.
void show_through(const SeenThrough& seen, const ShownPixels& shown, float share, Layers& layers);

}  // namespace lambent
