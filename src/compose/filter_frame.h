// SPDX-License-Identifier: Apache-2.0
// The parts of a frame's light that are filtered before they are shown.
#pragma once

#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gather/shown_gather.h"
#include "compose/gbuffer.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/layers.h"
#include "gather/gather.h"
#include "lambent/denoise.h"

namespace lambent {

/// Light that coats reflect from rays, one entry a pixel.
struct FilteredCoats {
  std::vector<glm::vec3> light;          ///< Without excess; divided by filtered_coat_albedo().
  std::vector<glm::vec3> excess;         ///< See CoatGuide; divided likewise.
  std::vector<glm::vec3> albedo;         ///< filtered_coat_albedo() times the fog's transmittance.
  std::vector<glm::vec3> normals_ws;     ///< Clearcoats' normals; empty for coats.
  std::vector<float> alphas;             ///< GGX widths; 0 where no rays light a coat.
  std::vector<float> inverse_distances;  ///< See CoatGuide.
  /// Variance of the luminance that a single ray brings to `light`, divided by the number of frames
  /// that are averaged. Neighbours take nearly the same rays, so that n pixels are worth n rays,
  /// though each takes more. Empty: unknown.
  std::vector<float> variance;
  std::vector<glm::vec3> filtered;  ///< Light and excess, once filtered; empty: there is none.

  /// Makes room for this many pixels; 0 for none.
  void resize(std::size_t pixels, bool has_variance);
};

/// The surfaces that mirrors show, one entry a pixel, and their light that is filtered. See
/// ShownBase.
struct MirroredBasePixels {
  std::vector<glm::vec3> positions_ws, normals_ws;
  std::vector<float> depths;            ///< By way of the mirror [m]; 0: the pixel shows none.
  std::vector<glm::vec3> emitters;      ///< Divided by albedo and level.
  std::vector<float> emitter_variance;  ///< Empty where one sample is taken.
  std::vector<float> emitter_levels;
  std::vector<glm::vec3> emitter_albedo;     ///< Factor to the camera's radiance.
  std::vector<glm::vec3> filtered_emitters;  ///< Empty where there is none.
  ShownGatherPixels gather;                  ///< Empty where the surfaces gather no light.

  /// Makes room for this many pixels; 0 for none.
  void resize(std::size_t pixels, bool has_variance);
};

/// One sample of the pixels of the traced rows. Its memory is reused for the next sample and frame.
struct FilteredPixels {
  // The surfaces that are seen
  std::vector<glm::vec3> positions_ws, normals_ws, geometric_normals_ws;
  std::vector<float> depths;
  // Light to be filtered, divided by the surfaces' albedo; the excess is that of gathered light
  std::vector<glm::vec3> gathered, excess, looked_up, emitters;
  std::vector<float> gathered_variance, emitter_variance;
  /// See NoisyLight::history_variance; empty where samples measure variances, or nothing does.
  std::vector<float> gathered_history_variance, emitter_history_variance;
  /// Hit::sample_weight where the pixel shows indirect light, else 0.
  std::vector<float> received_weight;
  // Factors from filtered light to the camera's radiance, including the fog's transmittance
  std::vector<glm::vec3> indirect_albedo;
  std::vector<glm::vec3> emitter_albedo;  ///< Times emitter_levels and unoccluded_tint().
  std::vector<float> emitter_levels;      ///< See filtered_level().
  FilteredCoats coats, clearcoats;
  FilteredCoats mirrored;                        ///< The coats that mirrors show.
  std::vector<glm::vec3> mirrored_positions_ws;  ///< Places of their mirror images.
  std::vector<float> mirrored_depths;            ///< [m]; 0: the pixel shows none.
  MirroredBasePixels mirrored_bases;
  std::vector<glm::vec3> to_viewer_ws;  ///< Empty where there are no coats.
  // Specular light of emitters, divided by filtered_coat_albedo() where rays light the coat. Its
  // lobes have a width of highlight_alpha()
  std::vector<glm::vec3> highlights, highlight_albedo;
  std::vector<float> highlight_alphas;
  std::vector<float> highlight_inverse_distances;  ///< See CoatGuide; valid where alphas are not 0.
  // Light once filtered
  std::vector<glm::vec3> filtered_gathered, filtered_emitters, filtered_highlights;
  std::vector<glm::vec3> filtered_excess;  ///< Of one kind of light after the other.

  SeenThrough through;  ///< Used in scenes with glass.

  Denoiser denoiser;
};

/// The light of a band that is to be filtered.
struct BandToFilter {
  const GBuffer& gbuffer;
  const ReflectedLight& direct;
  const GatheredLight* gathered = nullptr;            ///< Null: no light is gathered.
  const std::vector<glm::vec3>* looked_up = nullptr;  ///< Required with `gathered`.
  const ShownGather* in_mirrors = nullptr;            ///< Null: mirrors show no gathered light.
  const ShownGather* behind_glass = nullptr;          ///< Null: what is behind glass shows none.
  const CoatLight* coats = nullptr;                   ///< Null: no coat has rays.
  bool filters_clearcoats = false;                    ///< Requires `coats`.
  const ClearcoatsShown* clearcoats = nullptr;        ///< Null: the band has none.
  const TransmittedLight* transmitted = nullptr;      ///< Null: no surface transmits light.
  std::span<const glm::vec4> fog = {};  ///< See fog_along(); one a pixel; empty: there is no fog.
};

/// The number of pixels in the traced rows.
std::size_t traced_pixels(const FrameRequest& request);

/// Stores a band's sample.
void keep_pixels(const FrameRequest& request, const Band& band, const BandToFilter& light,
                 FilteredPixels& pixels);

/// Filters all bands' light. Fills the `filtered` arrays of `pixels`, empty where there is no
/// light.
void filter_pixels(const FrameRequest& request, FilteredPixels& pixels);

/// Adds the filtered light, times `share`, to the layers of the rows that are shown.
void show_filtered(const FilteredPixels& pixels, const ShownPixels& shown, float share,
                   Layers& layers);

}  // namespace lambent
