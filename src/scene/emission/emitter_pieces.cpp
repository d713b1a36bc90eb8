// SPDX-License-Identifier: Apache-2.0
#include "scene/emission/emitter_pieces.h"

#include <array>

namespace lambent {
namespace {

// Relative variance of luminance among a triangle's pieces up to which it is not divided: a
// standard deviation of a quarter of the mean adds less noise to a sample than distance, cosine and
// shadows do, and every piece makes the light tree deeper.
constexpr double kEven = 0.0625;

// This bit marks links to divisions. kDark has it, too, so test for kDark first.
constexpr std::uint32_t kDivided = 0x80000000u;

/// One of the four pieces that result from halving all edges of a piece, by its corner and size
/// relative to that one. The fourth, in the middle, is reversed.
struct Quarter {
  glm::vec2 corner;
  float size;
};
constexpr std::array<Quarter, 4> kQuarters = {
    {{{0.0f, 0.0f}, 0.5f}, {{0.5f, 0.0f}, 0.5f}, {{0.0f, 0.5f}, 0.5f}, {{0.5f, 0.5f}, -0.5f}}};

std::uint32_t quarter_of(const glm::vec2& barycentrics) {
  if (barycentrics.x >= 0.5f) return 1;
  if (barycentrics.y >= 0.5f) return 2;
  return barycentrics.x + barycentrics.y < 0.5f ? 0 : 3;
}

glm::vec2 uv_at(const UvTriangle& uvs, const glm::vec2& barycentrics) {
  return uvs.a + barycentrics.x * (uvs.b - uvs.a) + barycentrics.y * (uvs.c - uvs.a);
}

UvTriangle uvs_of_piece(const UvTriangle& uvs, const EmitterPiece& piece) {
  return {uv_at(uvs, piece.corner), uv_at(uvs, piece.corner + glm::vec2(piece.size, 0.0f)),
          uv_at(uvs, piece.corner + glm::vec2(0.0f, piece.size))};
}

}  // namespace

/// Sums over the smallest pieces into which a piece was divided, and the link to the result.
struct EmitterPieces::Measured {
  double sum = 0.0, squares = 0.0;  // of mean luminances
  double count = 0.0;
  std::uint32_t link = kDark;
};

std::uint32_t EmitterPieces::divide(const EmissionMap& map, const UvTriangle& triangle,
                                    int halvings, std::vector<EmitterPiece>& pieces) {
  const std::size_t first = pieces.size();
  const std::uint32_t link = measure(map, triangle, {}, halvings, pieces).link;
  // A triangle that was not divided gets the mean over the whole of it
  if (link == first) pieces.back().mean_luminance = map.mean_luminance(triangle);
  return link;
}

// Divides down to the smallest pieces, since a pattern may be even at every larger scale, and
// merges pieces that turn out to be even.
EmitterPieces::Measured EmitterPieces::measure(const EmissionMap& map, const UvTriangle& uvs,
                                               EmitterPiece piece, int halvings,
                                               std::vector<EmitterPiece>& pieces) {
  if (halvings == 0) {
    piece.mean_luminance = map.mean_luminance(uvs_of_piece(uvs, piece));
    const double mean = piece.mean_luminance;
    // Written so that a NaN, too, is left out
    if (!(mean > 0.0)) return {0.0, 0.0, 1.0, kDark};
    pieces.push_back(piece);
    return {mean, mean * mean, 1.0, static_cast<std::uint32_t>(pieces.size() - 1)};
  }

  const std::size_t first_piece = pieces.size(), first_link = links_.size();
  links_.resize(first_link + kQuarters.size(), kDark);
  Measured all;
  for (std::size_t i = 0; i < kQuarters.size(); ++i) {
    const EmitterPiece quarter{piece.corner + piece.size * kQuarters[i].corner,
                               piece.size * kQuarters[i].size};
    const Measured of_quarter = measure(map, uvs, quarter, halvings - 1, pieces);
    links_[first_link + i] = of_quarter.link;
    all.sum += of_quarter.sum;
    all.squares += of_quarter.squares;
    all.count += of_quarter.count;
  }
  const bool even = all.squares * all.count <= (1.0 + kEven) * all.sum * all.sum;
  if (!even) {
    all.link = kDivided | static_cast<std::uint32_t>(first_link / kQuarters.size());
    return all;
  }
  pieces.resize(first_piece);
  links_.resize(first_link);
  if (all.sum > 0.0) {
    piece.mean_luminance = static_cast<float>(all.sum / all.count);
    all.link = static_cast<std::uint32_t>(first_piece);
    pieces.push_back(piece);
  }
  return all;
}

std::uint32_t EmitterPieces::find(std::uint32_t link, glm::vec2 barycentrics) const {
  while (link != kDark && (link & kDivided) != 0) {
    const std::uint32_t quarter = quarter_of(barycentrics);
    barycentrics = (barycentrics - kQuarters[quarter].corner) / kQuarters[quarter].size;
    link = links_[(link & ~kDivided) * kQuarters.size() + quarter];
  }
  return link;
}

}  // namespace lambent
