// SPDX-License-Identifier: Apache-2.0
// The separable cross-bilateral filter, shared by all passes that blur light over a picture.
//
// Pictures are planes: one float array for each value of a pixel. The planes of a row are adjacent,
// so that values that a filter reads together are close in memory. Every row and the whole picture
// are padded with empty pixels (PlaneLayout), whose weight is 0, so that filters need no special
// cases at borders. Neighbours are given as pointers, so that horizontal passes, vertical ones and
// those across interleaved sub-images are the same loop.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "shared/cross_bilateral.h"

namespace lambent {

/// Default width of the padding around a picture [pixels], and the largest distance of taps with
/// it.
inline constexpr int kPlaneGuard = 8;

/// Memory layout of a picture of planes. In an AlignedFloats, the first pixel of each row and plane
/// is at the start of a cache line.
struct PlaneLayout {
  int width = 0, height = 0;
  int planes = 0;        ///< Values per pixel.
  int guard = 0;         ///< Least number of spare pixels on all sides, shared by planes.
  int lead = 0;          ///< Floats before the first pixel of a plane, `guard` or more.
  int stride = 0;        ///< Floats from plane to plane, a multiple of the lanes of a kernel.
  std::size_t size = 0;  ///< Floats, guards included.

  PlaneLayout() = default;
  PlaneLayout(int picture_width, int picture_height, int plane_count,
              int guard_width = kPlaneGuard);
  /// Index of pixel (0, y) in the first plane; each further plane is `stride` floats on.
  std::size_t row(int y) const {
    return (static_cast<std::size_t>(y + guard) * static_cast<std::size_t>(planes)) *
               static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(lead);
  }
};

/// Pointer to a pixel's values, which are followed by those of the next pixels in each plane;
/// planes are `stride` floats apart.
struct Planes {
  float* first = nullptr;
  std::ptrdiff_t stride = 0;
  float* at(int plane) const { return first + plane * stride; }
};
struct ConstPlanes {
  const float* first = nullptr;
  std::ptrdiff_t stride = 0;
  ConstPlanes() = default;
  ConstPlanes(const float* planes, std::ptrdiff_t apart) : first(planes), stride(apart) {}
  ConstPlanes(const Planes& planes) : first(planes.first), stride(planes.stride) {}
  const float* at(int plane) const { return first + plane * stride; }
};

/// Irradiance r, g, b. During the blur, each plane packs two values, which halves the memory
/// traffic: the upper half has the upper half of the irradiance's float, rounded, and the lower
/// half that of a component x, y, z of the reorientation R of shared/reorient_irradiance.h.
inline constexpr int kLightPlanes = 3;

/// The inputs of the filter for a pixel, or for a neighbour.
struct BlurSource {
  ConstPlanes guide;
  ConstPlanes light;    ///< Packed, two values in each float.
  float weight = 1.0f;  ///< Weight of the tap, multiplied by that for the scene's edges.
};

/// Neighbours on both sides and their weight; the pixel itself has weight 1.
struct BlurTap {
  int distance = 0;  ///< [pixels], 1 to the guard's width.
  float weight = 1.0f;
};

/// Taps of a box of 2 radius + 1 pixels.
std::vector<BlurTap> box_taps(int radius);

/// Taps of a box as wide as `period`, with half weights at the ends where that is even. All
/// positions modulo `period` have the same weight, so that on a plain surface a pattern of that
/// period averages out.
std::vector<BlurTap> period_taps(int period);

/// One direction of the filter, for `count` pixels of a row, rounded up to a multiple of kLanes:
/// each becomes the mean of itself (`here`, whose weight is not read) and of its neighbours,
/// weighted by relit_bilateral_weight. All pointers are to the row's first pixel, or to a neighbour
/// of that pixel. `plane_tolerance` is the distance from a pixel's plane at which others have no
/// weight, as a share of the pixel's depth. Input and output must differ. Single-threaded.
void cross_bilateral_row(const BlurSource& here, std::span<const BlurSource> neighbours,
                         const Planes& out, int count, float plane_tolerance);

/// The last direction of the filter: as cross_bilateral_row, but `out` becomes plain irradiance for
/// each pixel's own normal.
void cross_bilateral_row_relit(const BlurSource& here, std::span<const BlurSource> neighbours,
                               const Planes& out, int count, float plane_tolerance);

}  // namespace lambent
