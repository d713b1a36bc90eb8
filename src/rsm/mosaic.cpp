// SPDX-License-Identifier: Apache-2.0
#include "rsm/mosaic.h"

#include <algorithm>

#include "rsm/deinterleave.h"

namespace lambent {
namespace {

constexpr int kFirstLight = kGuidePlanes, kSecondLight = kFirstLight + kLightPlanes;
constexpr int kPlanes = kSecondLight + kLightPlanes;

// Places of a sub-image that are filled before those of the next: what was read of the view for the
// first is then still in the nearest cache for the others.
constexpr int kPlacesAtOnce = 64;

/// Quotient rounded down, also for negative values.
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

/// One over every `step`-th depth; 0 where the depth is 0 and nothing is seen.
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
                        kPlanes, (reach + sub_images - 1) / sub_images);
  floats_ = AlignedFloats(layout_.size * sub_images * sub_images);
}

std::size_t Mosaic::place(int i, int j, int row, int dx, int dy, int plane) const {
  const int column_step = floor_div(i + dx, sub_images_), row_step = floor_div(j + dy, sub_images_);
  const int sub_x = i + dx - column_step * sub_images_, sub_y = j + dy - row_step * sub_images_;
  const auto sub = static_cast<std::size_t>(sub_y * sub_images_ + sub_x);
  return sub * layout_.size + layout_.row(row + row_step) +
         static_cast<std::size_t>(plane) * layout_.stride + column_step;
}

ConstPlanes Mosaic::guide(int i, int j, int row, int dx, int dy) const {
  return {floats_.data() + place(i, j, row, dx, dy, 0), layout_.stride};
}

Planes Mosaic::light(Light which, int i, int j, int row, int dx, int dy) {
  const int plane = which == Light::current ? current_ : next_;
  return {floats_.data() + place(i, j, row, dx, dy, plane), layout_.stride};
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
      copy_strided(view.normals_ws.data() + from, p, count, to + kNormalPlane * stride, stride);
      invert_strided(view.depths.data() + from, p, count, to + kInverseDepthPlane * stride);
    }
  }
}

}  // namespace lambent
