// SPDX-License-Identifier: Apache-2.0
// The camera's picture as p x p sub-images, or as one where it is not restructured (p = 1).
//
// Sub-images are stored one after the other, (0, 0), (1, 0), ..., all with the layout of the
// largest. Each is stored row after row, and each row plane after plane, so that data that passes
// read together is close together: position x, y, z, normal x, y, z, one over depth, light
// (LightPlanes), light that is being blurred. Places that a smaller sub-image lacks have no
// surface.
#pragma once

#include <utility>

#include "core/cross_bilateral.h"
#include "core/large_pages.h"
#include "lambent/rsm.h"

namespace lambent {

class Mosaic {
 public:
  /// Makes room for a picture. Leaves the contents as they are where the shape is the same.
  /// `reach`: the farthest pixel of the picture that a blur reads, in pixels from its own.
  void reshape(int width, int height, int sub_images, int reach);

  int width() const { return width_; }
  int height() const { return height_; }
  int sub_images() const { return sub_images_; }
  const PlaneLayout& layout() const { return layout_; }

  /// Copies row y of the view to its places in sub-images (0, y mod p), (1, y mod p), ...
  void fill_row(const RsmView& view, int y);

  /// First pixel of a row of sub-image (i, j), offset by (dx, dy) pixels of the picture, which may
  /// lead to another sub-image. Offsets are at most `reach`.
  ConstPlanes guide(int i, int j, int row, int dx = 0, int dy = 0) const;
  /// The light that passes read, and the planes that they may write at the same time.
  enum class Light { current, next };
  Planes light(Light which, int i, int j, int row, int dx = 0, int dy = 0);
  /// Makes the light that was written the light that is read.
  void swap_lights() { std::swap(current_, next_); }

 private:
  std::size_t place(int i, int j, int row, int dx, int dy, int plane) const;

  int width_ = 0, height_ = 0, sub_images_ = 0, reach_ = 0;
  PlaneLayout layout_;
  int current_ = 0, next_ = 0;  // first plane of each light
  AlignedFloats floats_;
};

}  // namespace lambent
