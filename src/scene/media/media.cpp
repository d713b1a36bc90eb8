// SPDX-License-Identifier: Apache-2.0
#include "scene/media/media.h"

#include <algorithm>
#include <cmath>

namespace lambent {
namespace {

// Maximum number of steps to find the distance of an optical depth. Newton's method takes a few;
// where boxes begin and end it falls back to bisection, which reaches the resolution of a float
// after 40.
constexpr int kMaxSteps = 40;
// Error of the optical depth at which the search ends: rounding is as large.
constexpr float kDepthTolerance = 1e-6f;

MediumRecord record_of(const FogVolume& fog) {
  const float inverse_height = fog.scale_height > 0.0f ? 1.0f / fog.scale_height : 0.0f;
  return {fog.centre,     0.5f * fog.size, fog.axes,      fog.density,
          inverse_height, fog.albedo,      fog.anisotropy};
}

}  // namespace

Media::Media(const std::vector<FogVolume>& volumes) {
  for (const FogVolume& fog : volumes) {
    if (fog.density > 0.0f) records_.push_back(record_of(fog));
  }
}

MediumEvent Media::event_at(const glm::vec3& origin_ws, const glm::vec3& direction_ws, float t_max,
                            float depth, float u) const {
  const vec2 range = fog_range(*this, origin_ws, direction_ws, t_max);
  float low = range.x, high = std::max(range.x, range.y), t = low;
  const auto density_at = [&](const MediumRecord& medium) {
    const MediumSpan span = medium_span(medium, origin_ws, direction_ws, t_max);
    return t >= span.begin && t <= span.end ? span_density(span, t) : 0.0f;
  };
  const auto density = [&] {
    float sum = 0.0f;
    for (const MediumRecord& medium : records_) sum += density_at(medium);
    return sum;
  };
  for (int step = 0; step < kMaxSteps; ++step) {
    const float missing = depth - optical_depth(*this, origin_ws, direction_ws, 0.0f, t);
    if (std::abs(missing) <= kDepthTolerance * std::max(depth, kDepthTolerance)) break;
    (missing > 0.0f ? low : high) = t;
    const float next = t + missing / density();
    // Written so that NaN leads to bisection
    t = next > low && next < high ? next : 0.5f * (low + high);
  }

  MediumEvent event;
  event.distance = t;
  float left = u * density();
  for (const MediumRecord& medium : records_) {
    const float share = density_at(medium);
    if (share <= 0.0f) continue;
    event.albedo = medium.albedo;
    event.anisotropy = medium.anisotropy;
    left -= share;
    if (left < 0.0f) break;
  }
  return event;
}

}  // namespace lambent
