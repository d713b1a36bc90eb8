// SPDX-License-Identifier: Apache-2.0
// Temporal accumulation: averages a frame's light with that of previous frames before it is
// filtered.
#pragma once

#include <vector>

#include "compose/filter_frame.h"
#include "compose/history/lobe_history.h"
#include "compose/history/noise_history.h"

namespace lambent {

/// What a frame leaves to the next one, for the whole picture; for the arrays see FilteredPixels.
/// Memory is reused.
struct LightHistory {
  bool is_there = false;
  int averaged_lookups = 0;  ///< Number of coming frames that show lookups averaged.
  std::vector<glm::vec3> positions_ws;
  std::vector<glm::vec3> normals_ws;  ///< Geometric normals.
  std::vector<float> depths;
  std::vector<glm::vec3> differences;  ///< Gathered less looked-up light, averaged.
  std::vector<glm::vec3> looked_up;    ///< The lookups, averaged.
  std::vector<glm::vec3> excess, emitters;
  NoiseHistory gathered_noise, emitter_noise;
  std::vector<float> frames;           ///< Number of frames in a pixel's average of emitters.
  std::vector<float> gathered_frames;  ///< Number of frames in its average of gathered light.
  LobeHistory coats, clearcoats, highlights;
};

/// Averages the light that is to be filtered with that of previous frames, where the same surface
/// was seen, or lobes showed the same part of the scene. Light through glass is left alone. Stores
/// the average for the next frame. `last` is read where it is valid and light continues, or it is
/// known how it has changed; `next` is written.
void average_light(const FrameRequest& request, const LightHistory& last, FilteredPixels& pixels,
                   LightHistory& next);

}  // namespace lambent
