// SPDX-License-Identifier: Apache-2.0
// Light of the frames before, by which that of a frame is averaged before it is filtered.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compose/filter_frame.h"
#include "raytracing/motion/motion_math.h"

namespace lambent {

/// What a frame leaves to the next one; arrays as in FilteredPixels, of whole pictures. Memory is
/// used again.
struct LightHistory {
  bool is_there = false;
  std::vector<glm::vec3> normals_ws;  ///< Geometric.
  std::vector<float> depths;
  std::vector<glm::vec3> differences;  ///< Gathered light less that looked up, averaged.
  std::vector<glm::vec3> excess, emitters;
  std::vector<float> gathered_variance, emitter_variance;
  std::vector<float> frames;  ///< That a pixel's average holds.
};

/// Averages the light that is to be filtered with that of the frames before, where the same surface
/// was seen, and leaves the average to the next frame. `last` is read where it is there and the
/// request's light continues it; `next` is written.
void average_light(const FrameRequest& request, std::span<const PixelMotion> motion,
                   const LightHistory& last, FilteredPixels& pixels, LightHistory& next);

}  // namespace lambent
