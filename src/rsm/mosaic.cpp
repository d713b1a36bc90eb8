// SPDX-License-Identifier: Apache-2.0
#include "rsm/mosaic.h"

#include "rsm/deinterleave.h"

namespace lambent {
namespace {

constexpr int kPlanes = 13;
constexpr int kInverseDepth = 6, kFirstLight = 7, kSecondLight = 10;

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
  floats_.assign(layout_.size * kPlanes * sub_images * sub_images, 0.0f);
}

std::size_t Mosaic::place(int i, int j, int row, int dx, int dy, int plane) const {
  const int column_step = floor_div(i + dx, sub_images_), row_step = floor_div(j + dy, sub_images_);
  const int sub_x = i + dx - column_step * sub_images_, sub_y = j + dy - row_step * sub_images_;
  const auto sub = static_cast<std::size_t>(sub_y * sub_images_ + sub_x);
  return (sub * kPlanes + plane) * layout_.size + layout_.row(row + row_step) + column_step;
}

GuidePlanes Mosaic::guide(int i, int j, int row, int dx, int dy) const {
  const float* first = floats_.data() + place(i, j, row, dx, dy, 0);
  const std::size_t size = layout_.size;
  GuidePlanes result;
  result.position.at = {first, first + size, first + 2 * size};
  result.normal.at = {first + 3 * size, first + 4 * size, first + 5 * size};
  result.inverse_depth = first + kInverseDepth * size;
  return result;
}

Planes3 Mosaic::light(Light which, int i, int j, int row, int dx, int dy) {
  const int plane = which == Light::current ? current_ : next_;
  float* first = floats_.data() + place(i, j, row, dx, dy, plane);
  return {{first, first + layout_.size, first + 2 * layout_.size}};
}

void Mosaic::fill_row(const RsmView& view, int i, int j, int row) {
  const int y = pixel_of_sub_image({i, j}, {0, row}, sub_images_).y;
  if (y >= height_) return;
  const int count = sub_image_size(width_, i, sub_images_);
  const std::size_t first = static_cast<std::size_t>(y) * width_ + i;
  float* const start = floats_.data() + place(i, j, row, 0, 0, 0);
  const std::size_t size = layout_.size;
  copy_strided(view.positions_ws.data() + first, sub_images_, count, start, size);
  copy_strided(view.normals_ws.data() + first, sub_images_, count, start + 3 * size, size);
  invert_strided(view.depths.data() + first, sub_images_, count, start + kInverseDepth * size);
}

}  // namespace lambent
