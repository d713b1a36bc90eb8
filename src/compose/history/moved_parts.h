// SPDX-License-Identifier: Apache-2.0
// How far averages of light may reach back where the world has changed.
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

  /// The largest number of frames, >= 1, over which gathered light of a surface may be averaged,
  /// and the field's light at it, which follows edits at once.
  float frames_of_gathers(const vec3& position_ws, const vec3& normal_ws) const;

  /// The same for irradiance from emissive surfaces, which changes where parts may shade them.
  /// `normal_ws` of 0: that from all sides.
  float frames_of_emitters(const vec3& position_ws, const vec3& normal_ws) const;

  /// The same for what a lobe of some sharpness at a surface reflects.
  float frames_of_lobe(const vec3& position_ws, const LobeGuide& lobe) const;

 private:
  struct BoundingSphere {
    vec3 center_ws;
    float radius;  // [m]
  };

  std::vector<Bounds> boxes_;            // none of them empty; by kBoxMargin larger
  std::vector<Bounds> emitters_;         // none of them empty
  std::vector<BoundingSphere> spheres_;  // around the boxes
};

/// How light differs from that of a previous frame.
struct ChangedLight {
  MovedParts moved;       ///< Everything that moved.
  bool relit = false;     ///< Lights, materials or the sky differ.
  bool emitters = false;  ///< What is sampled as emissive surfaces are differs, or its shadows do.

  /// The largest number of frames, >= 1, over which irradiance of a surface from emissive surfaces
  /// may be averaged.
  float frames_of_emitters(const vec3& position_ws, const vec3& normal_ws) const;
};

/// How light has changed since a revision of the world; none where it may have changed in any way:
/// there are too many moved parts, or changes are no longer on record.
std::optional<ChangedLight> light_changed_since(const World& world, std::uint64_t revision);

}  // namespace lambent
