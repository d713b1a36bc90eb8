// SPDX-License-Identifier: Apache-2.0
// Where what the camera sees was on the picture before.
#pragma once

#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "raytracing/motion/motion_math.h"
#include "raytracing/motion/scene_pose.h"

namespace lambent {

/// The frame before, of the same size.
struct FrameBefore {
  Camera camera;
  bool at_rest = true;                    ///< No instance and no mesh has moved since.
  std::vector<InstanceBefore> instances;  ///< As many as there are now; none where all are at rest.
};

/// The views of a frame and of the one before; null: there was none.
MotionViews motion_views(const Camera& camera, int width, int height, const FrameBefore* before);

/// Whether rays may meet what is see-through and has no motion of its own.
bool has_see_through(const Scene& scene);

/// Motion of each pixel of a band whose hits are in the G-buffer. Returns the rays traced, through
/// what is see-through.
std::uint64_t find_motion(const FrameRequest& request, const Band& band, int sample,
                          const GBuffer& gbuffer, std::vector<PixelMotion>& motion);

/// The layer "motion" of pixels' motion: two channels, NaN where it is unknown.
Layer motion_layer(int width, int height, std::span<const PixelMotion> motion);

}  // namespace lambent
