// SPDX-License-Identifier: Apache-2.0
// The geometry of a field in a light stream: grids; places, states and distances of probes; and
// lookup corrections.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "field/probes/probe_grid.h"
#include "field/probes/probe_status.h"
#include "field/probes/volumes.h"
#include "lambent/field.h"
#include "stream/light/corrections.h"
#include "stream/light/light_state.h"

namespace lambent::stream {

/// Quantised moments of distance. The mean is in steps of 1 / 127 of the longest distance that the
/// grid stores, 0 where it is unknown. The standard deviation is in proportion to the square of its
/// number, where 63 is half the longest distance, the largest possible value.
struct CodedMoments {
  static constexpr int kMaxMean = 127, kMaxDeviation = 63;

  std::uint8_t mean = 0;
  std::uint8_t deviation = 0;

  bool operator==(const CodedMoments&) const = default;
};

// The standard deviation of numbers between 0 and 1 is at most this.
inline constexpr float kMaxDeviationShare = 0.5f;

/// The mean distance, and the standard deviation [m].
inline float decode_mean(const CodedMoments& moments, float longest) {
  return static_cast<float>(moments.mean) * (longest / CodedMoments::kMaxMean);
}
inline float decode_deviation(const CodedMoments& moments, float longest) {
  const auto root = static_cast<float>(moments.deviation);
  return root * root *
         (kMaxDeviationShare * longest /
          (CodedMoments::kMaxDeviation * CodedMoments::kMaxDeviation));
}

/// Convert mean distance [m] and mean squared distance [m^2] to coded moments, and back.
CodedMoments encode_moments(const glm::vec2& moments, float longest);
glm::vec2 decode_moments(const CodedMoments& moments, float longest);

/// The geometry of a field.
struct FieldGeometry {
  static constexpr std::size_t kMaxDistanceTexels = 32;  // along an edge of a tile

  int irradiance_texels = 4;
  int distance_texels = 14;
  std::vector<Volume> volumes;  ///< Their grids' `first` counts the probes of all volumes.
  std::vector<std::uint32_t> offsets;
  std::vector<ProbeState> states;
  std::vector<CodedMoments> moments;  ///< Tiles without gutter, one after the other.
  std::vector<CodedCorrectionBlock> corrections;
  std::uint64_t corrections_number = 0;  ///< The number of the geometry with which they appeared.

  int probes() const { return static_cast<int>(offsets.size()); }
  std::size_t tile() const { return static_cast<std::size_t>(distance_texels) * distance_texels; }
  std::span<const CodedMoments> tile_of(int probe) const {
    return std::span(moments).subspan(probe * tile(), tile());
  }
  const ProbeGrid& grid_of(int probe) const;
  /// Whether another one has as many probes, in tiles and volumes of the same kind, so that the
  /// changes between both can be coded.
  bool same_kind(const FieldGeometry& other) const;
};

/// Whether both grids are at the same place in the world and in memory.
bool same_place(const ProbeGrid& a, const ProbeGrid& b);

/// The volumes and sizes of tiles of a field, without its probes.
FieldGeometry kind_of(const IrradianceField& field);
/// The geometry of a field.
FieldGeometry geometry_of(const IrradianceField& field);
/// The lookup corrections of a field.
std::vector<CodedCorrectionBlock> corrections_of(const IrradianceField& field);

/// The layout of a geometry's light, for its coding.
LightLayout layout_of(const FieldGeometry& geometry);

/// Probes of a geometry that were updated.
struct UpdatedProbes {
  std::vector<int> probes;                 ///< In ascending order.
  std::vector<CodedMoments> tiles_before;  ///< Their former tiles, one after the other.
};

/// Updates `sent` from a field of the same kind: its grids, the probes that moved or came into or
/// out of solid matter, and, of every `stride`-th other probe, from number `first` on, those whose
/// distances have a root mean square error above `threshold` [smallest spacings]. Does not change
/// corrections.
UpdatedProbes follow(const IrradianceField& field, float threshold, int first, int stride,
                     FieldGeometry& sent);

}  // namespace lambent::stream
