// SPDX-License-Identifier: Apache-2.0
// The kernels that gather the light of texels at pixels. All work on rows of planes, kLanes
// neighbouring pixels at a time; they differ in where texels lie.
#pragma once

#include <cstdint>
#include <span>

#include "core/cross_bilateral.h"
#include "core/simd_levels.h"
#include "lambent/rsm.h"
#include "rsm/gather_texel.h"
#include "rsm/maps/choice.h"
#include "rsm/pattern.h"

namespace lambent {

/// Pixels of a row: where they are, and the light that they gather.
struct GatherRow {
  ConstPlanes guide;  ///< kGuidePlanes
  Planes light;       ///< kLightPlanes, of one value each
  /// kWayPlanes for the ways to the light, where it will be blurred; otherwise null. Of every
  /// kTexelsPerWay-th texel, which is enough for a mean.
  Planes ways;
  int count = 0;  ///< Pixels; more are touched, up to a multiple of kLanes.
};

/// x, y, z, summed over texels by the luminance that they bring.
inline constexpr int kWayPlanes = 3;

/// Makes of a row's light and the ways to it light that can be blurred: kLightPlanes of two values.
void make_reorientable(const GatherRow& row);

/// Gives every pixel of a row the light of the same texels; they lie one after the other.
void gather_contiguous(const GatherRow& row, std::span<const RsmTexel> texels);

/// The same texels where they were rendered: `places` tells where in `rendered`.
void gather_scattered(const GatherRow& row, const RsmTexel* rendered,
                      std::span<const std::uint32_t> places);

/// Gives each pixel the light of texels of its own sub-map, which differs from that of its
/// neighbour. `places` has kLanes entries for each of `count` texels: where in `texels` those of
/// the pixels at places 0 to kLanes - 1 of a row lie; it repeats along the row, so kLanes must be a
/// multiple of the period of sub-maps, or the row be gathered in pieces of kLanes pixels with
/// tables of their own.
void gather_per_pixel(const GatherRow& row, const RsmTexel* texels, const std::uint32_t* places,
                      std::size_t count);

/// One for each texel. `count` is a multiple of kLanes; a point without a normal adds nothing.
void sum_terms(const ConstPlanes& points, int count, std::span<const RsmTexel> texels,
               TermSums* sums);

/// Floats of a texel that a gather reads: position, normal, softening, flux over pi.
inline constexpr int kTexelFields = 10;

/// Adds one texel to each of kLanes pixels of a row from `first` on, of which the caller has
/// fetched the fields; and the ways to it, if asked.
void gather_fetched(const GatherRow& row, int first, const float (*fields)[kLanes], bool ways);

/// Samples of a disk around each pixel's projection, for pixels of different sub-maps.
struct DiskGather {
  const ReflectiveShadowMap* map = nullptr;  ///< Tells how pixels are projected.
  const RsmTexel* texels = nullptr;          ///< The map's, as rendered or restructured.
  int sub_maps = 1;                          ///< Along an edge.
  bool restructured = true;                  ///< Whether `texels` are.
  std::span<const DiskSample> samples;       ///< Of the whole disk, a multiple of sub_maps^2.
  float softening = 1.0f;                    ///< RsmSettings::softening
};

/// Adds a disk's samples to the pixels of a row. Pixel x of the row gathers from the sub-map in
/// column (first_column + x * column_step) mod sub_maps and row `sub_row`.
void gather_disk(const GatherRow& row, const DiskGather& disk, int first_column, int column_step,
                 int sub_row);

/// A map's texels, sub-map after sub-map: texel (x, y) is texel (x / n, y / n) of sub-map
/// (x mod n, y mod n). Every texel lands in exactly one, where sub_map_texel tells.
std::vector<RsmTexel> restructure_map(const ReflectiveShadowMap& map, int sub_maps);

}  // namespace lambent
