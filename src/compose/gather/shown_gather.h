// SPDX-License-Identifier: Apache-2.0
// Indirect light of the surfaces that pixels show in mirrors and behind glass, from rays of these.
// Lookups alone lose what is smaller than the probes' spacing, and their corrections differ from
// cell to cell, which would be seen there as bands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "gather/gather.h"
#include "glossy/coat_path.h"
#include "lambent/denoise.h"

namespace lambent {

/// The light that a band's shown surfaces gather, one entry a pixel. Memory is reused.
struct ShownGather {
  std::vector<Surface> surfaces;     ///< Undefined where `seen` is 0, and in part elsewhere.
  std::vector<std::uint8_t> seen;    ///< 1 where the surface gathers light.
  std::vector<glm::vec3> looked_up;  ///< Irradiance by lookups [W/m^2]; 0 where `seen` is.
  GatheredLight light;
  std::vector<std::size_t> asked;  ///< The pixels where `seen` is 1, their queries and answers.
  std::vector<FieldQuery> queries;
  std::vector<glm::vec3> answers;
};

/// Gathers the irradiance of the surfaces `bases`, one a pixel of the band; empty: the band shows
/// none. `sample`: index among the samples of all frames. Returns the number of rays traced.
std::uint64_t gather_shown(const FrameRequest& request, const Band& band, int sample,
                           std::span<const ShownBase> bases, ShownGather& found);

/// Light that shown surfaces gather, to be filtered: one entry for each pixel of the traced rows.
struct ShownGatherPixels {
  std::vector<glm::vec3> geometric_normals_ws;
  std::vector<glm::vec3> gathered, excess, looked_up;  ///< See FilteredPixels.
  std::vector<float> variance;                         ///< Empty where a surface has one ray.
  std::vector<glm::vec3> albedo;    ///< Factor from filtered light to what is shown.
  std::vector<glm::vec3> filtered;  ///< Empty where there is none.

  bool empty() const { return gathered.empty(); }
  /// Makes room for this many pixels; 0 for none.
  void resize(std::size_t pixels, bool has_variance);
  /// Stores what `base` of the band's pixel `i` gathered. `weight`: share of its ray's radiance
  /// that is shown.
  void keep(const ShownGather& found, const ShownBase& base, const glm::vec3& weight, std::size_t i,
            std::size_t pixel);
  /// Filters the light. `view`: places and depths of the surfaces.
  void filter(DenoiseView view, Denoiser& denoiser);

 private:
  std::vector<glm::vec3> scratch_;
};

}  // namespace lambent
