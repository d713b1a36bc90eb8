// SPDX-License-Identifier: Apache-2.0
// An orthonormal basis for the texels of a probe's tile.
//
// Irradiance is almost a spherical harmonic expansion up to degree 2 (Ramamoorthi and Hanrahan,
// JOSA A 18(10), 2001), so that few coefficients in harmonics represent most of a tile. At the N^2
// texels of an octahedral tile, polynomials of the direction are made orthonormal by Gram and
// Schmidt's process in the order of their degree: 1, 3, 5, ... of degree 0, 1, 2, ..., N^2 in all.
// Where some of a degree vanish at all texels, such as z in a tile of 2 x 2, polynomials of higher
// degree replace them.
#pragma once

#include <cstddef>
#include <vector>

namespace lambent::stream {

/// A basis of tiles of `edge` x `edge` texels. The last bits of its numbers depend on the compiler,
/// so it must not be used for data on which encoder and decoder must agree.
class TileBasis {
 public:
  explicit TileBasis(int edge);

  /// The number of texels, and of functions.
  std::size_t size() const { return size_; }
  /// The value of a function at a texel.
  float at(std::size_t function, std::size_t texel) const {
    return values_[function * size_ + texel];
  }
  /// The values of a function at all texels, row after row.
  const float* function(std::size_t index) const { return &values_[index * size_]; }
  /// The values of all functions at a texel.
  const float* texel(std::size_t index) const { return &transposed_[index * size_]; }

 private:
  std::size_t size_;
  std::vector<float> values_, transposed_;
};

}  // namespace lambent::stream
