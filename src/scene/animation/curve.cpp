// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, Appendix C "Animation Sampler Interpolation
// Modes".
#include <algorithm>
#include <cassert>
#include <cmath>

#include "lambent/animation.h"

namespace lambent {
namespace {

// If the cosine between two rotations is above this, the arc is nearly a line, and its sine is too
// small to divide by.
constexpr float kStraightArc = 0.9995f;

void normalize_quaternion(float* q) {
  const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (length > 0.0f) {
    for (int k = 0; k < 4; ++k) q[k] /= length;
  } else {
    q[3] = 1.0f;
  }
}

// Appendix C.4: along the shorter of the two arcs.
void slerp(const float* from, const float* to, float share, float* value) {
  float cosine = 0.0f;
  for (int k = 0; k < 4; ++k) cosine += from[k] * to[k];
  const float sign = cosine < 0.0f ? -1.0f : 1.0f;
  float from_weight = 1.0f - share, to_weight = share;
  if (std::abs(cosine) < kStraightArc) {
    const float angle = std::acos(std::abs(cosine));
    from_weight = std::sin(angle * (1.0f - share)) / std::sin(angle);
    to_weight = std::sin(angle * share) / std::sin(angle);
  }
  for (int k = 0; k < 4; ++k) value[k] = from_weight * from[k] + sign * to_weight * to[k];
}

// Appendix C.5: a Hermite spline whose tangents are scaled by the time between the keys.
void spline(const float* from_key, const float* to_key, int n, float share, float seconds,
            float* value) {
  const float t = share, t2 = t * t, t3 = t2 * t;
  const float* from = from_key + n;
  const float* tangent_out = from_key + 2 * static_cast<std::ptrdiff_t>(n);
  const float* tangent_in = to_key;
  const float* to = to_key + n;
  for (int k = 0; k < n; ++k) {
    value[k] = (2.0f * t3 - 3.0f * t2 + 1.0f) * from[k] +
               seconds * (t3 - 2.0f * t2 + t) * tangent_out[k] + (3.0f * t2 - 2.0f * t3) * to[k] +
               seconds * (t3 - t2) * tangent_in[k];
  }
}

}  // namespace

void evaluate(const Curve& curve, float time_s, bool rotation, float* value) {
  assert(!curve.times.empty());
  const int n = curve.components;
  const bool cubic = curve.interpolation == Interpolation::cubic;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(n) * (cubic ? 3 : 1);
  const auto next = std::upper_bound(curve.times.begin(), curve.times.end(), time_s);
  const std::ptrdiff_t after = next - curve.times.begin();
  const std::ptrdiff_t before = std::max<std::ptrdiff_t>(after - 1, 0);
  const float* from = curve.values.data() + before * stride;
  const bool between = after > 0 && next != curve.times.end();
  if (!between || curve.interpolation == Interpolation::step) {
    std::copy_n(from + (cubic ? n : 0), n, value);
  } else {
    const float* to = from + stride;
    const float seconds = curve.times[after] - curve.times[before];
    const float share = (time_s - curve.times[before]) / seconds;
    if (cubic) {
      spline(from, to, n, share, seconds, value);
    } else if (rotation) {
      slerp(from, to, share, value);
    } else {
      for (int k = 0; k < n; ++k) value[k] = from[k] + share * (to[k] - from[k]);
    }
  }
  if (rotation) normalize_quaternion(value);
}

float duration(const Animation& animation) {
  float last = 0.0f;
  for (const Channel& channel : animation.channels) {
    if (!channel.curve.times.empty()) last = std::max(last, channel.curve.times.back());
  }
  return last;
}

}  // namespace lambent
