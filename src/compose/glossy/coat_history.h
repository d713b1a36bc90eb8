// SPDX-License-Identifier: Apache-2.0
// Temporal accumulation of light that lobes reflect: averages a frame's reflections with those of
// the previous frames in which lobes showed the same part of the scene.
//
// Based on: Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, sec. 4.2, for
// which pixels show the same surface. Which lobes show the same light is the filter's measure.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "denoise/history_math.h"
#include "raytracing/motion/motion_math.h"

namespace lambent {

/// The lobe that reflects a pixel's light; for the members see LobeGuide.
struct LobeOfPixel {
  vec3 mirror_ws;
  float sharpness;  ///< 0: there is no lobe.
  float inverse_distance;
};

/// What the lobes of a frame leave to the next one, one entry a pixel.
struct LobeHistory {
  std::vector<LobeOfPixel> lobes;
  std::vector<vec3> light, excess;  ///< Averaged.
  std::vector<float> frames;        ///< Number of frames in a pixel's average; not whole.
};

/// The surfaces of a frame, one entry a pixel; see FilteredPixels.
struct SurfacesSeen {
  std::span<const vec3> positions_ws, geometric_normals_ws;
  std::span<const float> depths;
};

/// A frame's lobes and the light that they reflect, one entry a pixel.
struct LobesSeen {
  std::span<const vec3> normals_ws, to_viewer_ws;
  std::span<const float> alphas;  ///< GGX widths; 0: there is no lobe.
  std::span<const float> inverse_distances;
  std::span<vec3> light, excess;  ///< Replaced by the averages; `excess` may be empty.
};

/// How frames are averaged.
struct FrameAveraging {
  ivec2 size;         ///< Of the picture [pixels].
  MotionViews views;  ///< Of this frame and of the previous one.
  float most_frames;
};

/// Averages reflected light with that of the previous frame, `last`, and stores the average in
/// `next`. Each pixel's lobe is looked for where its surface was, and where the camera saw what the
/// lobe shows in the surface's plane; the place whose lobes agree better is used. `before`: the
/// surfaces of the previous frame; empty, as `last` is: there is no history.
void average_lobes(const FrameAveraging& by, std::span<const PixelMotion> motion,
                   const SurfacesSeen& now, const SurfacesSeen& before, const LobeHistory& last,
                   const LobesSeen& lobes, LobeHistory& next);

}  // namespace lambent
