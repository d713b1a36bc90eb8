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
  Denoiser denoiser;
  std::vector<vec3> level_before(depths_.size()), level_now(depths_.size());
  [[maybe_unused]] const bool done =
      denoiser.filter(small, {.light = before_here}, geometric_denoising(), level_before) &&
      denoiser.filter(small, {.light = now_here}, geometric_denoising(), level_now);
  assert(done);  // sizes are the view's
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    vec3& factor = factors_.emplace_back(0.0f);
    if (is_other_light(luminance(level_before[i]), luminance(level_now[i]))) continue;
    for (int c = 0; c < 3; ++c) factor[c] = followed_level(level_before[i][c], level_now[i][c]);
  }
}

vec3 LookupLevels::followed(const DenoiseView& view, std::size_t pixel, float tolerance) const {
  if (factors_.empty()) return vec3(1.0f);
  SurfacesBefore surfaces{{positions_ws_, normals_ws_, depths_}};
  const vec2 place = middle_of(pixel, {view.width, view.height}) / static_cast<float>(step_);
  const HistoryTaps taps =
      surfaces.history_taps(size_, place, view.depths[pixel], tolerance, view.normals_ws[pixel]);
  return is_history(taps) ? weighted_sum(factors_, taps) : vec3(1.0f);
}

}  // namespace lambent
