// SPDX-License-Identifier: Apache-2.0
// How much brighter the field's lookups have become over large parts of the picture.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "compose/history/history_taps.h"
#include "lambent/denoise.h"

namespace lambent {

/// How a pixel's average of previous frames follows the lookups of this frame.
struct FollowedLevel {
  vec3 factor;  ///< Brings the average to the level of this frame.
  float kept;   ///< Share of the average's frames that is kept, 0 to 1, see kept_by_lookup().
};

/// The change of level of lookups, from an average of previous frames to this frame. While light
/// moves, the lookups of each frame have noise of their own, about as large as a cell of the
/// probes' grid. Averages over frames remove it, and what is known of the light over many cells
/// keeps them from lagging behind.
class LookupLevels {
 public:
  /// Levels that do not change.
  LookupLevels() = default;

  /// `before` and `now`: lookups at the view's pixels [W/m^2], the average of previous frames and
  /// those of this frame. Pixels without a history have a depth of 0.
  LookupLevels(const DenoiseView& view, std::span<const vec3> before, std::span<const vec3> now);

  /// Distance of the pixels at which levels are found [pixels].
  int pixels_apart() const { return step_; }

  /// How a pixel's average follows, see followed_level(): in each channel, as light may have come
  /// to be reflected by surfaces of another colour. `kept` is 0 where it is of other light, see
  /// is_other_light(). Empty where no pixel around that shows its surface has a history.
  /// `tolerance`: of its surface's depth between pixels that are pixels_apart() apart [m], see
  /// depth_tolerance().
  std::optional<FollowedLevel> followed(const DenoiseView& view, std::size_t pixel,
                                        float tolerance) const;

 private:
  // Of every step_-th pixel of every step_-th row: lookups vary slowly, and the filter has to reach
  // far
  int step_ = 1;
  ivec2 size_{0};
  std::vector<vec3> positions_ws_, normals_ws_;
  std::vector<float> depths_;
  std::vector<vec3> factors_;
  std::vector<float> kept_;
};

}  // namespace lambent
