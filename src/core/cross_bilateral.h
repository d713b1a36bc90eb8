// SPDX-License-Identifier: Apache-2.0
// The separable cross-bilateral filter that every pass shares which blurs light over a picture.
//
// Pictures are planes: one float array for each value of a pixel. A row has its planes one after
// the other, so that what a filter reads together lies together. Every row is followed and the
// whole surrounded by pixels that see nothing (PlaneLayout), so that a filter needs no borders:
// what lies outside weighs nothing. Neighbours are given as pointers, so a horizontal pass, a
// vertical one and one across interleaved sub-images are the same loop.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "shared/cross_bilateral.h"

namespace lambent {

/// Usual width of what surrounds a picture [pixels], and the farthest that taps may reach then.
inline constexpr int kPlaneGuard = 8;

/// How a picture of planes lies in memory. In an AlignedFloats the first pixel of each row and
/// plane lies at the start of a cache line.
struct PlaneLayout {
  int width = 0, height = 0;
  int planes = 0;        ///< Values a pixel.
  int guard = 0;         ///< Pixels that see nothing, at least, on all sides.
  int lead = 0;          ///< Floats before the first pixel of a plane, `guard` or more.
  int stride = 0;        ///< Floats from plane to plane, a multiple of the lanes of a kernel.
  std::size_t size = 0;  ///< Floats, guards included.

  PlaneLayout() = default;
  PlaneLayout(int picture_width, int picture_height, int plane_count,
              int guard_width = kPlaneGuard);
  /// Where pixel (0, y) lies in the first plane; in others, `stride` floats on each.
  std::size_t row(int y) const {
    return (static_cast<std::size_t>(y + guard) * static_cast<std::size_t>(planes)) *
               static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(lead);
  }
};

/// A pixel's values, and those of the pixels after it: planes `stride` floats apart.
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

/// Irradiance r, g, b. While it is blurred, each holds two values, so that half as much memory is
/// read: in its upper half the upper half of the irradiance's float, rounded, in its lower half
/// that of a component x, y, z of what it is relit with, R of shared/reorient_irradiance.h.
inline constexpr int kLightPlanes = 3;

/// What the filter reads of a pixel, or of a neighbour.
struct BlurSource {
  ConstPlanes guide;
  ConstPlanes light;    ///< Of two values each.
  float weight = 1.0f;  ///< Before the scene's edges have their say.
};

/// A neighbour on both sides and how much it counts; the pixel itself counts 1.
struct BlurTap {
  int distance = 0;  ///< [pixels], 1 to the guard's width.
  float weight = 1.0f;
};

/// Taps of a box of 2 radius + 1 pixels.
std::vector<BlurTap> box_taps(int radius);

/// Taps of a box as wide as `period`, with halves at the ends where that is even: each place modulo
/// `period` counts the same, so on a plain surface they average a pattern of that period away.
std::vector<BlurTap> period_taps(int period);

/// One direction of the filter, for `count` pixels of a row (and more, up to a multiple of kLanes):
/// each becomes the mean of itself (`here`, whose weight is not read) and of its neighbours,
/// weighted by relit_bilateral_weight. All pointers are those of the row's first pixel, or of that
/// pixel's neighbour, wherever it lies. `plane_tolerance` is the share of a pixel's depth at which
/// another one is off its plane. Input and output must differ. Single-threaded.
void cross_bilateral_row(const BlurSource& here, std::span<const BlurSource> neighbours,
                         const Planes& out, int count, float plane_tolerance);

/// The same, and `out` becomes plain irradiance: what the blurred light brings each pixel's own
/// normal.
void cross_bilateral_row_relit(const BlurSource& here, std::span<const BlurSource> neighbours,
                               const Planes& out, int count, float plane_tolerance);

}  // namespace lambent
