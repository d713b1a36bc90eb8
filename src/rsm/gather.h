// SPDX-License-Identifier: Apache-2.0
// The kernels that gather the light of texels at pixels. All process rows of planes, kLanes
// neighbouring pixels at a time; they differ in how texels are addressed.
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

/// Pixels of a row: their geometry, and the light that they gather.
struct GatherRow {
  ConstPlanes guide;  ///< kGuidePlanes planes.
  Planes light;       ///< kLightPlanes planes, of one value each.
  /// kDirectionPlanes planes for the mean direction of the light, where the light will be blurred;
  /// otherwise null. Sums over every kTexelsPerDirection-th texel, which is enough for a mean.
  Planes directions;
  int count = 0;  ///< Number of pixels; up to the next multiple of kLanes are written.
};

/// x, y and z of the vectors to texels, summed over texels, weighted by the luminance they
/// contribute.
inline constexpr int kDirectionPlanes = 3;

/// Packs a row's light and its mean direction into light that can be blurred: kLightPlanes planes
/// of two values.
void make_reorientable(const GatherRow& row);

/// Gathers the same texels, which are contiguous, at every pixel of a row.
void gather_contiguous(const GatherRow& row, std::span<const RsmTexel> texels);

/// The same for texels at the indices `places` of `rendered`.
void gather_scattered(const GatherRow& row, const RsmTexel* rendered,
                      std::span<const std::uint32_t> places);

/// Gathers the texels of its own sub-map at each pixel, which are other ones than its neighbour's.
/// `places` has kLanes entries for each of `count` texels: the indices in `texels` for the pixels
/// at places 0 to kLanes - 1 of a row. They repeat along the row, so that kLanes must be a multiple
/// of the period of sub-maps; otherwise, gather the row in pieces of kLanes pixels with a table for
/// each.
void gather_per_pixel(const GatherRow& row, const RsmTexel* texels, const std::uint32_t* places,
                      std::size_t count);

/// The sums of each texel's terms over points. `count` is a multiple of kLanes; points without a
/// normal add nothing.
void sum_terms(const ConstPlanes& points, int count, std::span<const RsmTexel> texels,
               TermSums* sums);

/// Floats of a texel that a gather reads: position, normal, softening and flux over pi.
inline constexpr int kTexelFields = 10;

/// Adds one texel to each of kLanes pixels of a row from `first` on, given the texels' fields.
/// `directions`: also adds the vectors to them.
void gather_fetched(const GatherRow& row, int first, const float (*fields)[kLanes],
                    bool directions);

/// A disk of samples around each pixel's projection, for pixels of different sub-maps.
struct DiskGather {
  const ReflectiveShadowMap* map = nullptr;  ///< Supplies the projection.
  const RsmTexel* texels = nullptr;          ///< The map's texels, as rendered or restructured.
  int sub_maps = 1;                          ///< Number of sub-maps along an edge.
  bool restructured = true;                  ///< Whether `texels` are restructured.
  std::span<const DiskSample> samples;       ///< The whole disk; a multiple of sub_maps^2.
  float softening = 1.0f;                    ///< RsmSettings::softening
};

/// Adds a disk's samples to the pixels of a row. Pixel x of the row gathers from the sub-map in
/// column (first_column + x * column_step) mod sub_maps and row `sub_row`.
void gather_disk(const GatherRow& row, const DiskGather& disk, int first_column, int column_step,
                 int sub_row);

/// A map's texels, sub-map after sub-map: texel (x, y) becomes texel (x / n, y / n) of sub-map
/// (x mod n, y mod n), at index sub_map_texel().
std::vector<RsmTexel> restructure_map(const ReflectiveShadowMap& map, int sub_maps);

}  // namespace lambent
