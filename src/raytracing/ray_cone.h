// SPDX-License-Identifier: Apache-2.0
// Ray cones: a ray stands for all that the cone around it hits, whose width selects MIP levels
// (scene/mip_level.h).
// Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984; Akenine-Moeller et al., "Texture Level of
// Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, 2019.
#ifndef LAMBENT_RAYTRACING_RAY_CONE_H
#define LAMBENT_RAYTRACING_RAY_CONE_H

#include "raytracing/camera_math.h"

LAMBENT_BEGIN

struct RayCone {
  float width;   ///< Width where the ray starts [m].
  float spread;  ///< Growth along the ray [m/m].
};
LAMBENT_DEVICE_ARRAY(RayConeArray, RayCone, 4)

// Widths of pixels' cones [pixels]. Of 0.5 to 1.4, one gives the albedos nearest to the
// reference's. Under temporal anti-aliasing, several samples make up a pixel, and cones are
// narrower.
const float kPixelConeWidth = 1.0f;
const float kTemporalConeWidth = 0.5f;

// A ray that is drawn from a lobe stands for this share of the reciprocal of its density: pixels
// reuse the rays of sixteen (kOwnShare of glossy_math.h).
const float kLobeShare = 1.0f / 16.0f;

/// The cone of one of a pixel's samples. `jitter`: see subpixel_position(); 0 without temporal
/// anti-aliasing.
LAMBENT_FN RayCone camera_cone(CameraRecord camera, vec3 direction_ws, uint samples, uint jitter) {
  float pixel = camera.half_view / camera.half_size.y *
                (jitter != 0u ? kTemporalConeWidth : kPixelConeWidth) / sqrt(float(samples));
  RayCone cone = {pixel, 0.0f};
  if (camera.orthographic != 0u) return cone;
  // The width of a pixel grows with the distance from the camera's plane, not with that along the
  // ray
  cone.width = 0.0f;
  cone.spread = pixel * max(-dot(direction_ws, normalize(camera.axes[2])), 0.0f);
  return cone;
}

/// Width of a cone at a distance along its ray [m].
LAMBENT_FN float width_at(RayCone cone, float distance) {
  return cone.width + cone.spread * distance;
}

/// The cone of a ray that was drawn with density `pdf` [1/sr] at the end of another one, whose cone
/// there is `at_end`. Surfaces are taken to be flat: curved ones widen cones, so that textures in
/// their reflections are read at finer levels than needed.
LAMBENT_FN RayCone reflected_cone(RayCone at_end, float pdf) {
  RayCone cone = {at_end.width, sqrt(at_end.spread * at_end.spread + kLobeShare / pdf)};
  return cone;
}

LAMBENT_END
#endif
