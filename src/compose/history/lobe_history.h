// SPDX-License-Identifier: Apache-2.0
// Temporal accumulation of light that lobes reflect, of coats, clearcoats and highlights: averages
// it with that of the previous frames in which lobes showed the same part of the scene.
//
// Based on: Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, sec. 4.2, for
// which pixels show the same surface. Which lobes show the same light is the filter's measure.
#pragma once

#include <span>
#include <vector>

#include "compose/history/history_taps.h"
#include "compose/history/moved_parts.h"
#include "denoise/atrous_pass.h"
#include "raytracing/motion/motion_math.h"

namespace lambent {

/// What the lobes of a frame leave to the next one, one entry a pixel.
struct LobeHistory {
  std::vector<LobeGuide> lobes;
  std::vector<vec3> light, excess;  ///< Averaged.
  std::vector<float> frames;        ///< Number of frames in a pixel's average; not whole.
};

/// A frame's lobes and the light that they reflect, one entry a pixel.
struct LobesSeen {
  std::span<const vec3> normals_ws, to_viewer_ws;
  std::span<const float> alphas;  ///< GGX widths; 0: there is no lobe.
  std::span<const float> inverse_distances;
  std::span<vec3> light, excess;  ///< Replaced by the averages; `excess` may be empty.
  /// Of `light`; replaced by that of the averages; empty: unknown.
  std::span<float> variance = {};
};

/// How frames are averaged.
struct FrameAveraging {
  ivec2 size;                         ///< Of the picture [pixels].
  MotionViews views;                  ///< Of this frame and of the previous one.
  float most_frames;                  ///< A new frame counts at least as one of so many, >= 1.
  const MovedParts* moved = nullptr;  ///< Since the previous frame; null: none.
};

/// Averages reflected light with that of the previous frame, `last`, and stores the average in
/// `next`. The world must not have changed in between but by `by.moved`. Each pixel's lobe is
/// looked for where its surface was, and where the camera saw, in the surface's plane, what the
/// lobe shows; the place whose lobes agree better is used. `before`: the surfaces of the previous
/// frame; empty: there is no history.
void average_reflected_light(const FrameAveraging& by, const SurfacesSeen& now,
                             const SurfacesSeen& before, const LobeHistory& last,
                             const LobesSeen& lobes, LobeHistory& next);

}  // namespace lambent
