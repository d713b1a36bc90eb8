// SPDX-License-Identifier: Apache-2.0
// How far averages of light may reach back where parts of the world have moved.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "denoise/atrous_pass.h"
#include "lambent/world.h"
#include "shared/lang.h"

namespace lambent {

/// The parts of a world that moved since a frame, and the lights whose shadows they may move.
class MovedParts {
 public:
  /// `moved`: boxes around all that moved, before and after [m]. `emitters`: boxes around groups of
  /// the emissive surfaces.
  MovedParts(std::span<const Bounds> moved, std::span<const Bounds> emitters);

  /// Whether a point may be on one of the parts: it is in the box around one.
  bool contain(const vec3& position_ws) const;

  /// The largest number of frames, >= 1, over which the light of a surface may be averaged:
  /// irradiance from emissive surfaces, and what gathered light differs by from the field's, which
  /// follows edits at once.
  float frames_of_surface(const vec3& position_ws, const vec3& normal_ws) const;

  /// The same for what a lobe of some sharpness at a surface reflects.
  float frames_of_lobe(const vec3& position_ws, const LobeGuide& lobe) const;

 private:
  struct BoundingSphere {
    vec3 center_ws;
    float radius;  // [m]
  };
  static std::vector<BoundingSphere> around(std::span<const Bounds> boxes);
  /// The largest number for light that comes from all sides of a point.
  float frames_around(const vec3& position_ws, const vec3& normal_ws) const;
  bool may_shade(const BoundingSphere& part, const vec3& position_ws) const;

  std::vector<Bounds> boxes_;  // around all that moved
  std::vector<BoundingSphere> moved_, emitters_;
};

/// The parts that moved since a revision of the world; none where light may have changed
/// everywhere, because an edit relights, there are too many parts, or they are no longer on record.
std::optional<MovedParts> moved_since(const World& world, std::uint64_t revision);

}  // namespace lambent
