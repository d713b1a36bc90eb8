// SPDX-License-Identifier: Apache-2.0
#include "rsm/mosaic.h"

#include <algorithm>

#include "core/simd_levels.h"
#include "rsm/deinterleave.h"

namespace lambent {
namespace {

constexpr int kInverseDepth = 6, kFirstLight = 7, kSecondLight = kFirstLight + kLightPlanes;
constexpr int kPlanes = kSecondLight + kLightPlanes;

// Places of a sub-image that are filled before those of the next: what is read of the view for the
// first is still in the nearest cache for the others.
constexpr int kPlacesAtOnce = 64;

/// Quotient rounded down, of any sign.
int floor_div(int value, int divisor) {
  return value >= 0 ? value / divisor : -((divisor - 1 - value) / divisor);
}

/// Copies every `step`-th vector to three planes.
void copy_strided(const glm::vec3* from, int step, int count, float* __restrict to,
                  std::size_t plane) {
  float* __restrict x = to;
  float* __restrict y = to + plane;
  float* __restrict z = to + 2 * plane;
  for (int k = 0; k < count; ++k, from += step) {
    x[k] = from->x;
    y[k] = from->y;
    z[k] = from->z;
  }
}

/// One over every `step`-th depth; 0 for a depth of 0, where nothing is seen.
void invert_strided(const float* from, int step, int count, float* __restrict to) {
  for (int k = 0; k < count; ++k) {
    const float depth = from[static_cast<std::ptrdiff_t>(k) * step];
    to[k] = depth > 0.0f ? 1.0f / depth : 0.0f;
  }
}

}  // namespace

void Mosaic::reshape(int width, int height, int sub_images, int reach) {
  if (width == width_ && height == height_ && sub_images == sub_images_ && reach == reach_) return;
  width_ = width;
  height_ = height;
  sub_images_ = sub_images;
  reach_ = reach;
  current_ = kFirstLight;
  next_ = kSecondLight;
  layout_ = PlaneLayout(sub_image_size(width, 0, sub_images), sub_image_size(height, 0, sub_images),
                        (reach + sub_images - 1) / sub_images);
  const auto rows = static_cast<std::size_t>(layout_.height + 2 * layout_.guard);
  sub_image_size_ = rows * row_size();
  // Beyond the last row of the last sub-image lie its guard and what whole lanes touch
  floats_.assign(sub_image_size_ * sub_images * sub_images + layout_.guard + kLanes, 0.0f);
}

std::size_t Mosaic::row_size() const {
  return static_cast<std::size_t>(kPlanes) * layout_.stride;
}

std::size_t Mosaic::place(int i, int j, int row, int dx, int dy, int plane) const {
  const int column_step = floor_div(i + dx, sub_images_), row_step = floor_div(j + dy, sub_images_);
  const int sub_x = i + dx - column_step * sub_images_, sub_y = j + dy - row_step * sub_images_;
  const auto sub = static_cast<std::size_t>(sub_y * sub_images_ + sub_x);
  return sub * sub_image_size_ + (row + row_step + layout_.guard) * row_size() +
         static_cast<std::size_t>(plane) * layout_.stride + layout_.guard + column_step;
}

GuidePlanes Mosaic::guide(int i, int j, int row, int dx, int dy) const {
  const float* first = floats_.data() + place(i, j, row, dx, dy, 0);
  const int stride = layout_.stride;
  GuidePlanes result;
  result.position.at = {first, first + stride, first + 2 * stride};
  result.normal.at = {first + 3 * stride, first + 4 * stride, first + 5 * stride};
  result.inverse_depth = first + kInverseDepth * stride;
  return result;
}

LightPlanes Mosaic::light(Light which, int i, int j, int row, int dx, int dy) {
  const int plane = which == Light::current ? current_ : next_;
  float* first = floats_.data() + place(i, j, row, dx, dy, plane);
  LightPlanes result;
  for (int c = 0; c < kLightPlanes; ++c) result.at[c] = first + c * layout_.stride;
  return result;
}

void Mosaic::fill_row(const RsmView& view, int y) {
  if (y >= height_) return;
  const int p = sub_images_, places = sub_image_size(width_, 0, p);
  const auto stride = static_cast<std::size_t>(layout_.stride);
  for (int first = 0; first < places; first += kPlacesAtOnce) {
    for (int i = 0; i < p; ++i) {
      const int count = std::min(kPlacesAtOnce, sub_image_size(width_, i, p) - first);
      if (count <= 0) continue;
      const std::size_t from = static_cast<std::size_t>(y) * width_ + first * p + i;
      float* const to = floats_.data() + place(i, y % p, y / p, 0, 0, 0) + first;
      copy_strided(view.positions_ws.data() + from, p, count, to, stride);
      copy_strided(view.normals_ws.data() + from, p, count, to + 3 * stride, stride);
      invert_strided(view.depths.data() + from, p, count, to + kInverseDepth * stride);
    }
  }
}

}  // namespace lambent
