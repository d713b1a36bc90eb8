// SPDX-License-Identifier: Apache-2.0
// The fog of a scene, prepared for lookups.
#pragma once

#include <vector>

#include "lambent/scene.h"
#include "scene/media/medium.h"
#include "shared/phase.h"

namespace lambent {

/// A scattering event along a ray.
struct MediumEvent {
  float distance = 0.0f;  ///< [m]
  glm::vec3 albedo{0.0f};
  float anisotropy = 0.0f;
};

/// Boxes of fog; those of no density are left out.
class Media {
 public:
  Media() = default;
  explicit Media(const std::vector<FogVolume>& volumes);

  bool empty() const { return records_.empty(); }
  const std::vector<MediumRecord>& records() const { return records_; }

  /// The event at an optical depth along a ray. `depth` must not exceed the optical depth up to
  /// `t_max`; `u` picks the box where several overlap.
  MediumEvent event_at(const glm::vec3& origin_ws, const glm::vec3& direction_ws, float t_max,
                       float depth, float u) const;

 private:
  std::vector<MediumRecord> records_;
};

// The types and functions that media.inl.h requires.
using MediaRef = const Media&;
inline uint media_count(const Media& media) {
  return static_cast<uint>(media.records().size());
}
inline const MediumRecord& fetch_medium(const Media& media, uint medium) {
  return media.records()[medium];
}

#include "scene/media/media.inl.h"

}  // namespace lambent
