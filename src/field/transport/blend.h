// SPDX-License-Identifier: Apache-2.0
// Blending: from values along rays to the texels of a probe's tile, as one matrix product.
//
// In an update all probes use the same ray directions w_i, so the weight of ray i in texel t (unit
// direction n_t) is the same for all of them: max(0, n_t . w_i)^e, with e = 1 for irradiance and a
// high exponent for distances. With W the texels x rays matrix of these weights and V the rays x
// channels matrix of a probe's values, the probe's texels are W V, divided by each texel's sum of
// the weights of the rays that count.
//
// Based on: Majercik et al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance
// Fields", JCGT 8(2), 2019.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "shared/lang.h"

namespace lambent {

/// Unit directions of an update's rays: a spherical Fibonacci lattice under a rotation drawn for
/// the update.
std::vector<vec3> probe_ray_directions(int count, uint update, uint seed);

/// The matrix W of ray weights for tiles of one kind.
class BlendMatrix {
 public:
  /// `texels` along a tile's edge, without gutter.
  BlendMatrix(int texels, float cosine_exponent, std::span<const vec3> directions);
  /// Any texels x rays matrix, given column (ray) after column.
  BlendMatrix(int texel_count, int ray_count, std::span<const float> columns);

  int texels() const { return texel_count_; }  ///< Texels of a tile, without gutter.
  int rays() const { return ray_count_; }

  /// Computes the weighted sums over the rays of 2 or 4 channels. `values` has rays x channels
  /// floats, ray after ray; `sums` has texels x channels floats, texel after texel.
  void apply2(const float* values, float* sums) const;
  void apply4(const float* values, float* sums) const;

  /// The weight of a ray in a texel. For tests and tools.
  float weight(int texel, int ray) const {
    return weights_[static_cast<std::size_t>(ray) * padded_texels_ + texel];
  }

 private:
  int texel_count_;
  int padded_texels_;  // rounded up to whole blocks of the kernel
  int ray_count_;
  std::vector<float> weights_;  // ray after ray; a ray's weights are consecutive for vector code
};

}  // namespace lambent
