// SPDX-License-Identifier: Apache-2.0
// The separable cross-bilateral filter that every pass shares which blurs light over a picture.
//
// Pictures are planes: one float array a channel. Rows lie `stride` floats apart, and every row is
// followed and the whole surrounded by pixels that see nothing (PlaneLayout), so that a filter
// needs no borders: what lies outside weighs nothing. Neighbours are given as pointers, so a
// horizontal pass, a vertical one and one across interleaved sub-images are the same loop.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lambent {

/// Usual width of what surrounds a picture [pixels], and the farthest that taps may reach then.
inline constexpr int kPlaneGuard = 8;

/// How a picture of planes lies in memory.
struct PlaneLayout {
  int width = 0, height = 0;
  int guard = 0;         ///< Pixels that see nothing, on all sides.
  int stride = 0;        ///< Floats from row to row, a multiple of the lanes of a kernel.
  std::size_t size = 0;  ///< Floats a plane, guards included.

  PlaneLayout() = default;
  PlaneLayout(int picture_width, int picture_height, int guard_width = kPlaneGuard);
  /// Where pixel (0, y) lies.
  std::size_t row(int y) const {
    return static_cast<std::size_t>(y + guard) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(guard);
  }
};

/// Three planes of values.
struct Planes3 {
  std::array<float*, 3> at{};
};
struct ConstPlanes3 {
  std::array<const float*, 3> at{};
  ConstPlanes3() = default;
  ConstPlanes3(const Planes3& planes) : at{planes.at[0], planes.at[1], planes.at[2]} {}
};

/// Light that can be relit (shared/relight.h): irradiance r, g, b and the mean way to the light x, y,
/// z, times luminance.
inline constexpr int kLightPlanes = 6;
struct LightPlanes {
  std::array<float*, kLightPlanes> at{};
};
struct ConstLightPlanes {
  std::array<const float*, kLightPlanes> at{};
  ConstLightPlanes() = default;
  ConstLightPlanes(const LightPlanes& planes) {
    for (int c = 0; c < kLightPlanes; ++c) at[c] = planes.at[c];
  }
};

/// What tells a pixel's surface from its neighbours'.
struct GuidePlanes {
  ConstPlanes3 position;                 ///< [m]
  ConstPlanes3 normal;                   ///< Unit; 0 where nothing is seen.
  const float* inverse_depth = nullptr;  ///< [1/m]
};

/// What the filter reads of a pixel, or of a neighbour.
struct BlurSource {
  GuidePlanes guide;
  ConstLightPlanes value;
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
/// weighted by cross_bilateral_weight. All pointers are those of the row's first pixel, or of that
/// pixel's neighbour, wherever it lies. `plane_tolerance` is the share of a pixel's depth at which
/// another one is off its plane. Input and output must differ. Single-threaded.
void cross_bilateral_row(const BlurSource& here, std::span<const BlurSource> neighbours,
                         const LightPlanes& out, int count, float plane_tolerance);

}  // namespace lambent
