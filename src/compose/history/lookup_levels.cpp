// SPDX-License-Identifier: Apache-2.0
#include "compose/history/lookup_levels.h"

#include <algorithm>
#include <cassert>

#include "shared/color.h"

namespace lambent {
namespace {

// Pictures of more rows than this are read at every second, third, ... pixel. The filter, which
// reaches 63 of these pixels, then averages over a third to two thirds of the picture's height: in
// a room that fills the picture, over several cells of a grid of probes. It averages over all of a
// much smaller picture.
constexpr int kMaxLevelRows = 180;
// Passes of the filter for changes of smaller extent, such as a patch of sun that leaves a wall: it
// reaches 31 pixels, which are about two cells in a picture of 160x90 of a room.
constexpr int kLocalPasses = 5;
// Noise of these means, as kLevelNoise. With it, nine tenths of a patch of 1.4 times the light are
// followed (LookupLevels.FollowLightThatLeavesPartOfAWall), and the ninth decile of second
// differences of irradiance in LookupLevels.KeepWallsCalmWhileLightMoves is 0.108.
constexpr float kLocalLevelNoise = 0.12f;

/// Light over surfaces around each pixel, averaged without regard to its own differences.
std::vector<vec3> level_of(const DenoiseView& view, std::span<const vec3> light, int passes) {
  DenoiseSettings settings = geometric_denoising();
  settings.passes = settings.geometric_passes = passes;
  std::vector<vec3> level(light.size());
  Denoiser denoiser;
  [[maybe_unused]] const bool done =
      denoiser.filter(view, {.light = light}, settings, level).has_value();
  assert(done);  // sizes are the view's
  return level;
}

/// The factor by which each channel of an average follows a change of level with this `noise`.
vec3 followed_levels(const vec3& before, const vec3& now, float noise) {
  vec3 factor;
  for (int c = 0; c < 3; ++c) factor[c] = followed_level(before[c], now[c], noise);
  return factor;
}

}  // namespace

LookupLevels::LookupLevels(const DenoiseView& view, std::span<const vec3> before,
                           std::span<const vec3> now)
    : step_((view.height + kMaxLevelRows - 1) / kMaxLevelRows),
      size_((view.width + step_ - 1) / step_, (view.height + step_ - 1) / step_) {
  std::vector<vec3> before_here, now_here;
  for (int k = 0; k < size_.x * size_.y; ++k) {
    // The last column and row may have less than step_ pixels
    const int x = std::min(k % size_.x * step_ + step_ / 2, view.width - 1);
    const int y = std::min(k / size_.x * step_ + step_ / 2, view.height - 1);
    const auto i = static_cast<std::size_t>(y * view.width + x);
    positions_ws_.push_back(view.positions_ws[i]);
    normals_ws_.push_back(view.normals_ws[i]);
    depths_.push_back(view.depths[i]);
    before_here.push_back(before[i]);
    now_here.push_back(now[i]);
  }
  DenoiseView small;
  small.width = size_.x;
  small.height = size_.y;
  small.positions_ws = positions_ws_;
  small.normals_ws = normals_ws_;
  small.depths = depths_;
  const int passes = geometric_denoising().passes;
  const std::vector<vec3> level_before = level_of(small, before_here, passes);
  const std::vector<vec3> level_now = level_of(small, now_here, passes);
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    factors_.push_back(followed_levels(level_before[i], level_now[i], kLevelNoise));
    before_here[i] *= factors_[i];
  }
  // Changes of smaller extent have more noise
  const std::vector<vec3> local_before = level_of(small, before_here, kLocalPasses);
  const std::vector<vec3> local_now = level_of(small, now_here, kLocalPasses);
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    const vec3 local = followed_levels(local_before[i], local_now[i], kLocalLevelNoise);
    factors_[i] *= local;
    const bool other = is_other_light(luminance(level_before[i]), luminance(level_now[i]));
    kept_.push_back(
        other ? 0.0f : kept_by_lookup(luminance(local * local_before[i]), luminance(local_now[i])));
  }
}

std::optional<FollowedLevel> LookupLevels::followed(const DenoiseView& view, std::size_t pixel,
                                                    float tolerance) const {
  if (factors_.empty()) return std::nullopt;
  SurfacesBefore surfaces{{positions_ws_, normals_ws_, depths_}};
  const vec2 place = middle_of(pixel, {view.width, view.height}) / static_cast<float>(step_);
  const HistoryTaps taps =
      surfaces.history_taps(size_, place, view.depths[pixel], tolerance, view.normals_ws[pixel]);
  if (!is_history(taps)) return std::nullopt;
  return FollowedLevel{weighted_sum(factors_, taps), weighted_sum(kept_, taps)};
}

}  // namespace lambent
