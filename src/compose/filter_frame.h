// SPDX-License-Identifier: Apache-2.0
// Light of a frame that is filtered before it is shown.
#pragma once

#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/layers.h"
#include "gather/gather.h"
#include "lambent/denoise.h"

namespace lambent {

/// One sample of the pixels of the traced rows. Its memory is used again from sample to sample and
/// from frame to frame.
struct FilteredPixels {
  // What is seen
  std::vector<glm::vec3> positions_ws, normals_ws, geometric_normals_ws;
  std::vector<float> depths;
  // Light to be filtered, and what surfaces make of it once it is
  std::vector<glm::vec3> gathered, excess, looked_up, emitters;
  std::vector<float> gathered_variance, emitter_variance;
  std::vector<std::uint8_t> receives;  ///< 1 where indirect light counts.
  // What comes to the camera of light that is: that of surfaces, as far as fog lets it through
  std::vector<glm::vec3> indirect_albedo;
  std::vector<glm::vec3> emitter_albedo;  ///< Times the levels.
  std::vector<float> emitter_levels;      ///< As of filtered_level.
  // Light that coats reflect by rays, without filtered_coat_albedo, and what they see
  std::vector<glm::vec3> coats, coat_albedo, to_viewer_ws;
  std::vector<float> coat_alphas;  ///< 0 where no rays light a coat.
  std::vector<float> coat_inverse_distances;
  // Specular light of emitters, without filtered_coat_albedo where rays light the coat; the lobes
  // are those of highlight_alpha
  std::vector<glm::vec3> highlights, highlight_albedo;
  std::vector<float> highlight_alphas;
  // Light that is
  std::vector<glm::vec3> filtered_gathered, filtered_excess, filtered_emitters, filtered_coats,
      filtered_highlights;

  SeenThrough through;  ///< Of scenes with glass.

  Denoiser denoiser;
};

/// Light of a band that is to be filtered.
struct BandToFilter {
  const GBuffer& gbuffer;
  const ReflectedLight& direct;
  const GatheredLight* gathered = nullptr;            ///< Null: it is not gathered.
  const std::vector<glm::vec3>* looked_up = nullptr;  ///< With `gathered`.
  const CoatLight* coats = nullptr;                   ///< Null: none have rays.
  const TransmittedLight* transmitted = nullptr;      ///< Null: no surface lets light through.
  std::span<const glm::vec4> fog = {};  ///< As of fog_along, a pixel each; empty: there is none.
};

/// How many pixels the traced rows have.
std::size_t traced_pixels(const FrameRequest& request);

/// Keeps a band's sample.
void keep_pixels(const FrameRequest& request, const Band& band, const BandToFilter& light,
                 FilteredPixels& pixels);

/// Filters all of them. The filtered light stands in `pixels`, empty where there was none.
void filter_pixels(const FrameRequest& request, FilteredPixels& pixels);

/// Adds the filtered light to the layers of the rows that are shown, with this weight.
void show_filtered(const FilteredPixels& pixels, const ShownPixels& shown, float share,
                   Layers& layers);

}  // namespace lambent
