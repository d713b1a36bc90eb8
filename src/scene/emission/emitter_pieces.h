// SPDX-License-Identifier: Apache-2.0
// Emissive triangles in pieces that are drawn by their own power.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/emission/emission_map.h"

namespace lambent {

/// A piece of an emissive triangle, similar to it, as in EmitterRecord; or the whole triangle.
struct EmitterPiece {
  glm::vec2 corner{0.0f};  ///< Barycentrics of its first corner in the triangle.
  /// Ratio of its edges to the triangle's, a power of two; < 0: the edges are reversed.
  float size = 1.0f;
  /// Mean emitted luminance, without vertex colours [W/(m^2 sr)]; > 0 for pieces that emit.
  float mean_luminance = 0.0f;
};

/// Quadtrees over divided emissive triangles, which find the piece that contains a point.
class EmitterPieces {
 public:
  /// A link that leads to no piece, since nothing emits there.
  static constexpr std::uint32_t kDark = 0xffffffffu;

  /// Divides a triangle where its texture emits unevenly, at most `halvings` times, and appends the
  /// pieces that emit to `pieces`. Returns the link from which find() finds their indices in
  /// `pieces`.
  std::uint32_t divide(const EmissionMap& map, const UvTriangle& triangle, int halvings,
                       std::vector<EmitterPiece>& pieces);

  /// Returns the index of the piece that contains a point of a triangle, or kDark. `link` is the
  /// result of divide() for the triangle; for one that was not divided, the index of its only
  /// piece.
  std::uint32_t find(std::uint32_t link, glm::vec2 barycentrics) const;

 private:
  struct Measured;
  Measured measure(const EmissionMap& map, const UvTriangle& uvs, EmitterPiece piece, int halvings,
                   std::vector<EmitterPiece>& pieces);

  /// Four links per division: indices of pieces, kDark, or further divisions.
  std::vector<std::uint32_t> links_;
};

}  // namespace lambent
