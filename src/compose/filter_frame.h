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

/// Light that coats reflect by rays, a pixel each.
struct FilteredCoats {
  std::vector<glm::vec3> light;          ///< Without filtered_coat_albedo,
  std::vector<glm::vec3> albedo;         ///< and that, as far as fog lets it through.
  std::vector<glm::vec3> normals_ws;     ///< Of clearcoats; empty where coats have the surface's.
  std::vector<float> alphas;             ///< 0 where none such lights a coat.
  std::vector<float> inverse_distances;  ///< As of CoatLight.
  std::vector<glm::vec3> filtered;       ///< Empty where there is none.

  /// Makes room for so many pixels; 0 for none.
  void resize(std::size_t pixels);
};

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
  FilteredCoats coats, clearcoats;
  std::vector<glm::vec3> to_viewer_ws;  ///< Where there are coats.
  // Specular light of emitters, without filtered_coat_albedo where rays light the coat; the lobes
  // are those of highlight_alpha
  std::vector<glm::vec3> highlights, highlight_albedo;
  std::vector<float> highlight_alphas;
  // Light that is
  std::vector<glm::vec3> filtered_gathered, filtered_excess, filtered_emitters, filtered_highlights;

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
  bool filters_clearcoats = false;                    ///< With `coats`.
  const ClearcoatsShown* clearcoats = nullptr;        ///< Null: none are in the band.
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
