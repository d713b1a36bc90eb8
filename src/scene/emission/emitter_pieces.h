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
  /// Length of its edges over that of the triangle's, a power of two; < 0: they point the other
  /// way.
  float size = 1.0f;
  /// Mean luminance that it emits, without vertex colours [W/(m^2 sr)], > 0 of pieces that emit.
  float mean_luminance = 0.0f;
};

/// Quadtrees over the triangles that are lights in pieces: which piece does a point lie in?
class EmitterPieces {
 public:
  /// A link that leads to no piece, for nothing emits there.
  static constexpr std::uint32_t kDark = 0xffffffffu;

  /// Divides a triangle where its texture emits unevenly, at most `halvings` times, and appends
  /// what emits to `pieces`. Returns the link from which find() finds them again, by their places
  /// there.
  std::uint32_t divide(const EmissionMap& map, const UvTriangle& triangle, int halvings,
                       std::vector<EmitterPiece>& pieces);

  /// Returns the number of the piece that a point of a triangle lies in, or kDark. `link` is what
  /// divide() returned for the triangle; of one that was not divided, the number of its only piece.
  std::uint32_t find(std::uint32_t link, glm::vec2 barycentrics) const;

 private:
  struct Measured;
  Measured measure(const EmissionMap& map, const UvTriangle& uvs, EmitterPiece piece, int halvings,
                   std::vector<EmitterPiece>& pieces);

  /// Four links a division: numbers of pieces, kDark, or further divisions.
  std::vector<std::uint32_t> links_;
};

}  // namespace lambent
