// SPDX-License-Identifier: Apache-2.0
// What the previous frame showed around a place, for averaging light over frames.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "denoise/history_math.h"
#include "raytracing/motion/motion_math.h"

namespace lambent {

/// The surfaces of a frame, one entry a pixel; see FilteredPixels.
struct SurfacesSeen {
  std::span<const vec3> positions_ws, geometric_normals_ws;
  std::span<const float> depths;
};

/// The surfaces of the previous frame, as history.inl.h reads them.
struct SurfacesBefore {
  float fetch_depth_before(int pixel) const { return seen.depths[static_cast<std::size_t>(pixel)]; }
  vec3 fetch_normal_before(int pixel) const {
    return seen.geometric_normals_ws[static_cast<std::size_t>(pixel)];
  }

#include "denoise/history.inl.h"

  SurfacesSeen seen;
};

/// Motion of a point that is where it was in the previous frame, by the camera alone. Where it
/// does not hold, MovedParts ends averages. A pixel's motion vector is no help: that of a
/// blended surface belongs to what is behind it.
inline PixelMotion camera_motion(const MotionViews& views, const vec3& position_ws) {
  return motion_between(image_point(views.now, position_ws),
                        image_point(views.before, position_ws));
}

/// Middle of a pixel [pixels].
inline vec2 middle_of(std::size_t pixel, const ivec2& size) {
  const int index = static_cast<int>(pixel);
  return {static_cast<float>(index % size.x) + 0.5f, static_cast<float>(index / size.x) + 0.5f};
}

/// Sum of the values of the taps' pixels, times the taps' weights.
template <class T>
T weighted_sum(const std::vector<T>& values, const HistoryTaps& taps) {
  T sum(0.0f);
  for (int k = 0; k < 4; ++k) {
    if (taps.weights[k] > 0.0f) {
      sum += taps.weights[k] * values[static_cast<std::size_t>(taps.pixels[k])];
    }
  }
  return sum;
}

}  // namespace lambent
