// SPDX-License-Identifier: Apache-2.0
// Motion vectors: where the surfaces that the camera sees were in the previous picture.
#pragma once

#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "raytracing/motion/motion_math.h"
#include "raytracing/motion/scene_pose.h"

namespace lambent {

/// The previous frame, of the same size.
struct FrameBefore {
  Camera camera;
  bool at_rest = true;                    ///< No instance and no mesh has moved since.
  std::vector<InstanceBefore> instances;  ///< One for each present instance; empty where at_rest.
};

/// The views of a frame and of the previous one; null: there was none.
MotionViews motion_views(const Camera& camera, int width, int height, const FrameBefore* before);

/// Whether rays may hit blended surfaces, which have no motion vectors of their own.
bool has_see_through(const Scene& scene);

/// Motion of each pixel of a band whose hits are in the G-buffer. Returns the number of rays
/// traced, through blended surfaces.
std::uint64_t find_motion(const FrameRequest& request, const Band& band, int sample,
                          const GBuffer& gbuffer, std::vector<PixelMotion>& motion);

/// The layer "motion": two channels, NaN where the motion is unknown.
Layer motion_layer(int width, int height, std::span<const PixelMotion> motion);

}  // namespace lambent
