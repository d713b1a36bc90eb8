// SPDX-License-Identifier: Apache-2.0
// Motion vectors: where the point that a pixel shows was in the previous picture.
#ifndef LAMBENT_RAYTRACING_MOTION_MOTION_MATH_H
#define LAMBENT_RAYTRACING_MOTION_MOTION_MATH_H

#include "raytracing/camera_math.h"

LAMBENT_BEGIN

// Motion beyond this counts as unknown [pixels]: four sides of the largest picture. Points that
// were that far off the picture have no use, and their motion may be all rounding.
const float kFarthestMotion = 65536.0f;

// Value of PixelMotion::known where the point moved in the world, not by the camera alone.
const uint kObjectMotion = 2u;
// Least motion in the world that counts as such [pixels]. Less is rounding, or invisible.
const float kLeastOwnMotion = 0.02f;

/// Motion of the point that a pixel shows; where that is on a blended surface (AlphaMode::blend),
/// of the point behind it. The point may have been hidden in the previous frame, or off the
/// picture: readers have to check that.
struct PixelMotion {
  vec2 offset;         ///< Previous minus present place [pixels], +x right, +y down; 0: unknown.
  float depth;         ///< From the camera's plane [m]; infinite: the sky.
  float depth_before;  ///< In the previous frame [m]; infinite: the sky; 0: unknown.
  uint known;          ///< Not 0: the offset is known; kObjectMotion: the point moved in the
                       ///< world, too. 0: there was no previous frame, or no such point in it.
};
LAMBENT_DEVICE_ARRAY(PixelMotionArray, PixelMotion, 4)

/// The views of a frame and of the previous one.
struct MotionViews {
  CameraRecord now;
  CameraRecord before;
  uint has_before;  ///< 0: there was no previous frame of this size.
};

LAMBENT_FN PixelMotion unknown_motion(float depth) {
  PixelMotion motion = {vec2(0.0f), depth, 0.0f, 0u};
  return motion;
}

LAMBENT_FN PixelMotion motion_between(ImagePoint now, ImagePoint before) {
  vec2 offset = before.pixel - now.pixel;
  bool near_enough = abs(offset.x) < kFarthestMotion && abs(offset.y) < kFarthestMotion;
  // Written so that a depth of NaN counts as unknown: it fails every comparison
  if (!(before.depth > 0.0f && near_enough)) return unknown_motion(now.depth);
  PixelMotion motion = {offset, now.depth, before.depth, 1u};
  return motion;
}

/// Motion of an infinitely distant point in a direction, which the cameras' rotation alone causes.
LAMBENT_FN PixelMotion sky_motion(MotionViews views, vec3 direction_ws) {
  // An orthographic camera shows one direction, a perspective one many: no point can be tracked
  if (views.has_before == 0u || views.now.orthographic != views.before.orthographic) {
    return unknown_motion(infinity());
  }
  return motion_between(image_point_of_sky(views.now, direction_ws),
                        image_point_of_sky(views.before, direction_ws));
}

/// The motion of the nearer of two samples, which is that of their pixel.
LAMBENT_FN PixelMotion nearer_motion(PixelMotion a, PixelMotion b) {
  if (b.depth < a.depth) return b;
  return a;
}

LAMBENT_END
#endif
