// SPDX-License-Identifier: Apache-2.0
// Where what a pixel shows was on the picture before.
#ifndef LAMBENT_RAYTRACING_MOTION_MOTION_MATH_H
#define LAMBENT_RAYTRACING_MOTION_MOTION_MATH_H

#include "raytracing/camera_math.h"

LAMBENT_BEGIN

// Motion beyond this counts as unknown [pixels]: four sides of the largest picture. What was that
// far off the picture tells nothing, and may be all rounding.
const float kFarthestMotion = 65536.0f;

// Value of PixelMotion::known where the point moved in the world, not by the camera alone.
const uint kMotionOfItself = 2u;
// Least motion in the world that counts as such [pixels]. Less is rounding, or does not show.
const float kLeastOwnMotion = 0.02f;

/// Motion of what a pixel shows, or behind a see-through surface (AlphaMode::blend) of what it
/// shows through that. The point may have been hidden in the frame before, or off the picture: that
/// is for the reader to find out.
struct PixelMotion {
  vec2 offset;         ///< Where it was less where it is [pixels], +x right, +y down; 0: unknown.
  float depth;         ///< From the camera's plane [m]; infinite: the sky.
  float depth_before;  ///< In the frame before [m]; infinite: the sky; 0: unknown.
  uint known;          ///< Not 0: the offset is known; kMotionOfItself: the point moved in the
                       ///< world, too. 0: there was no frame before, or no such thing.
};
LAMBENT_DEVICE_ARRAY(PixelMotionArray, PixelMotion, 4)

/// The views of a frame and of the one before.
struct MotionViews {
  CameraRecord now;
  CameraRecord before;
  uint has_before;  ///< 0: there was no frame before of this size.
};

LAMBENT_FN PixelMotion unknown_motion(float depth) {
  PixelMotion motion = {vec2(0.0f), depth, 0.0f, 0u};
  return motion;
}

LAMBENT_FN PixelMotion motion_between(ImagePoint now, ImagePoint before) {
  vec2 offset = before.pixel - now.pixel;
  bool near_enough = abs(offset.x) < kFarthestMotion && abs(offset.y) < kFarthestMotion;
  // Written so that a depth that is not a number counts as unknown: it fails every comparison
  if (!(before.depth > 0.0f && near_enough)) return unknown_motion(now.depth);
  PixelMotion motion = {offset, now.depth, before.depth, 1u};
  return motion;
}

/// Motion of what is infinitely far away in a direction: by the cameras' rotation alone.
LAMBENT_FN PixelMotion sky_motion(MotionViews views, vec3 direction_ws) {
  // A camera of parallel rays shows one direction, any other many: nothing can be followed
  if (views.has_before == 0u || views.now.orthographic != views.before.orthographic) {
    return unknown_motion(infinity());
  }
  return motion_between(image_point_of_sky(views.now, direction_ws),
                        image_point_of_sky(views.before, direction_ws));
}

/// The motion of the nearer of two samples of a pixel, which is the one that the pixel has.
LAMBENT_FN PixelMotion nearer_motion(PixelMotion a, PixelMotion b) {
  if (b.depth < a.depth) return b;
  return a;
}

LAMBENT_END
#endif
