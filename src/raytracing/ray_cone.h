// SPDX-License-Identifier: Apache-2.0
// How wide rays are: what a ray brings back stands for all that the cone around it meets, by which
// MIP levels are chosen. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984; Akenine-Moeller et
// al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, 2019.
#ifndef LAMBENT_RAYTRACING_RAY_CONE_H
#define LAMBENT_RAYTRACING_RAY_CONE_H

#include "raytracing/camera_math.h"

LAMBENT_BEGIN

struct RayCone {
  float width;   ///< Where the ray starts [m].
  float spread;  ///< By how much it grows along the ray [m/m].
};
LAMBENT_DEVICE_ARRAY(RayConeArray, RayCone, 4)

// Widths of pixels' cones [pixels]. Of 0.5 to 1.4, one brings albedos nearest to the reference's.
// Where pictures are anti-aliased over time, several samples make up a pixel.
const float kPixelConeWidth = 1.0f;
const float kTemporalConeWidth = 0.5f;

// A ray that is drawn of a lobe stands for this share of one over its density: pixels take the rays
// of sixteen (kOwnShare of glossy_math.h).
const float kLobeShare = 1.0f / 16.0f;

/// The cone of one of a pixel's samples. `jitter` is that of subpixel_position: 0 where pictures
/// are not anti-aliased over time.
LAMBENT_FN RayCone camera_cone(CameraRecord camera, vec3 direction_ws, uint samples, uint jitter) {
  float pixel = camera.half_view / camera.half_size.y *
                (jitter != 0u ? kTemporalConeWidth : kPixelConeWidth) / sqrt(float(samples));
  RayCone cone = {pixel, 0.0f};
  if (camera.orthographic != 0u) return cone;
  // A pixel is as wide as its distance from the camera's plane says
  cone.width = 0.0f;
  cone.spread = pixel * max(-dot(direction_ws, normalize(camera.axes[2])), 0.0f);
  return cone;
}

/// Width of a cone so far along its ray [m].
LAMBENT_FN float width_at(RayCone cone, float distance) {
  return cone.width + cone.spread * distance;
}

/// The cone of a ray that was drawn with density `pdf` [1/sr] where another one ends, which has
/// this width there. Surfaces are taken to be flat: curved ones widen cones, and textures seen in
/// them are read finer than they need be.
LAMBENT_FN RayCone reflected_cone(RayCone at_end, float pdf) {
  RayCone cone = {at_end.width, sqrt(at_end.spread * at_end.spread + kLobeShare / pdf)};
  return cone;
}

LAMBENT_END
#endif
