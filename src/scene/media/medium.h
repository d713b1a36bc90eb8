// SPDX-License-Identifier: Apache-2.0
// A box of fog: its density along a ray in closed form. How it scatters is shared/phase.h.
// Based on: Wenzel, "Real-time Atmospheric Effects in Games", SIGGRAPH 2006 course (the integral of
// exponential height fog).
#ifndef LAMBENT_SCENE_MEDIA_MEDIUM_H
#define LAMBENT_SCENE_MEDIA_MEDIUM_H

#include "shared/constants.h"

LAMBENT_BEGIN

/// A box of fog in the form that shared mathematics uses; see struct FogVolume of fog.h.
struct MediumRecord {
  vec3 centre_ws;        ///< [m]
  vec3 half_size;        ///< Half of its edges [m].
  mat3 axes;             ///< Columns: its axes in world space.
  float density;         ///< Extinction, at the bottom of the box [1/m].
  float inverse_height;  ///< One over the scale height [1/m]; 0: the density is constant.
  vec3 albedo;
  float anisotropy;
};
LAMBENT_DEVICE_ARRAY(MediumArray, MediumRecord, 4)

/// The part of a ray within a box, and the density there: at distance t it is
/// density * exp(-(height + rise * (t - begin))), where the exponent is at most 0.
struct MediumSpan {
  float begin;    ///< Distance along the ray [m].
  float end;      ///< Not above `begin`: the ray misses the box.
  float density;  ///< At the bottom of the box [1/m].
  float height;   ///< Height above the bottom where the ray enters, in scale heights.
  float rise;     ///< Change of the height along the ray [1/m].
};

// Directions with a smaller component along an axis count as parallel to the box's faces: the
// distance to these would be beyond all coordinates.
const float kAlongsideFaces = 1e-12f;
// For smaller exponents, (1 - exp(-x)) / x is computed from its series, whose relative error is
// then 1e-10: the difference of two numbers close to 1 would have only five digits.
const float kSmallExponent = 0.01f;

/// The part of a ray, up to a distance, within a box of fog.
LAMBENT_FN MediumSpan medium_span(MediumRecord medium, vec3 origin_ws, vec3 direction_ws,
                                  float t_max) {
  vec3 origin = (origin_ws - medium.centre_ws) * medium.axes;
  vec3 direction = direction_ws * medium.axes;
  float begin = 0.0f;
  float end = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    float half_edge = medium.half_size[axis];
    if (abs(direction[axis]) < kAlongsideFaces) {
      if (abs(origin[axis]) >= half_edge) end = 0.0f;
      continue;
    }
    float inverse = 1.0f / direction[axis];
    float to_first = (-half_edge - origin[axis]) * inverse;
    float to_second = (half_edge - origin[axis]) * inverse;
    begin = max(begin, min(to_first, to_second));
    end = min(end, max(to_first, to_second));
  }
  MediumSpan span = {begin, end, medium.density, 0.0f, 0.0f};
  span.height = (origin.y + begin * direction.y + medium.half_size.y) * medium.inverse_height;
  span.rise = direction.y * medium.inverse_height;
  return span;
}

/// The density at a distance along the ray, which is within the span [1/m].
LAMBENT_FN float span_density(MediumSpan span, float t) {
  return span.density * exp(-max(span.height + span.rise * (t - span.begin), 0.0f));
}

/// (1 - exp(-x)) / x for x >= 0.
LAMBENT_FN float mean_of_decay(float x) {
  if (x < kSmallExponent) return 1.0f - x * (0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f)));
  return (1.0f - exp(-x)) / x;
}

/// The integral of the density from one distance to another, which need not be within the span.
/// With the density s_0 exp(-r t) over a length L it is [s_0 L (1 - exp(-r L)) / (r L)]. Computed
/// from the denser end, so that exponents are negative.
LAMBENT_FN float span_optical_depth(MediumSpan span, float from, float to) {
  float begin = max(span.begin, from);
  float end = min(span.end, to);
  if (!(end > begin)) return 0.0f;
  float denser = span.rise < 0.0f ? end : begin;
  return span_density(span, denser) * (end - begin) * mean_of_decay(abs(span.rise) * (end - begin));
}

/// The density of a box of fog at a point [1/m]; 0 outside.
LAMBENT_FN float medium_density(MediumRecord medium, vec3 position_ws) {
  vec3 position = (position_ws - medium.centre_ws) * medium.axes;
  vec3 outside = abs(position) - medium.half_size;
  if (max(outside.x, max(outside.y, outside.z)) > 0.0f) return 0.0f;
  return medium.density * exp(-(position.y + medium.half_size.y) * medium.inverse_height);
}

LAMBENT_END
#endif
