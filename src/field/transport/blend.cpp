// SPDX-License-Identifier: Apache-2.0
#include "field/transport/blend.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/simd.h"
#include "field/probes/tile.h"
#include "field/transport/blend_math.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// The number of texels that the kernel holds in registers at a time, as one vector. The compiler
// splits it into vectors of the processor's width.
constexpr int kBlock = 16;
typedef float Block __attribute__((vector_size(kBlock * sizeof(float))));

// Distinguishes the random numbers of ray rotations from those of other passes.
constexpr uint kRotationSalt = 0x52415953u;

/// One block of texels: sums[t][c] = sum over rays of values[ray][c] * weights[ray][t].
template <int channels>
__attribute__((always_inline)) inline void accumulate_block(const float* weights, int stride,
                                                            const float* values, int rays,
                                                            float* sums) {
  Block block[channels] = {};
  for (int ray = 0; ray < rays; ++ray) {
    Block w;
    std::memcpy(&w, weights + static_cast<std::size_t>(ray) * stride, sizeof(w));
    for (int c = 0; c < channels; ++c) block[c] += values[ray * channels + c] * w;
  }
  for (int t = 0; t < kBlock; ++t) {
    for (int c = 0; c < channels; ++c) sums[t * channels + c] = block[c][t];
  }
}

LAMBENT_SIMD_CLONES void accumulate2(const float* weights, int stride, const float* values,
                                     int rays, float* sums) {
  accumulate_block<2>(weights, stride, values, rays, sums);
}

LAMBENT_SIMD_CLONES void accumulate4(const float* weights, int stride, const float* values,
                                     int rays, float* sums) {
  accumulate_block<4>(weights, stride, values, rays, sums);
}

template <int channels, class Accumulate>
void apply(const std::vector<float>& weights, int padded, int texels, int rays, const float* values,
           float* out, Accumulate accumulate) {
  int first = 0;
  for (; first + kBlock <= texels; first += kBlock) {
    accumulate(weights.data() + first, padded, values, rays, out + first * channels);
  }
  if (first < texels) {
    float sums[channels * kBlock];
    accumulate(weights.data() + first, padded, values, rays, sums);
    std::copy_n(sums, (texels - first) * channels, out + first * channels);
  }
}

}  // namespace

std::vector<vec3> probe_ray_directions(int count, uint update, uint seed) {
  RandomStream stream = make_random_stream(update, kRotationSalt, seed);
  const float u = next_uniform(stream);
  const float v = next_uniform(stream);
  const mat3 rotation = sample_uniform_rotation({u, v, next_uniform(stream)});
  std::vector<vec3> directions(count);
  for (int i = 0; i < count; ++i) {
    directions[i] = normalize(rotation * spherical_fibonacci(i, count));
  }
  return directions;
}

BlendMatrix::BlendMatrix(int texels, float cosine_exponent, std::span<const vec3> directions)
    : texel_count_(texels * texels),
      padded_texels_((texel_count_ + kBlock - 1) / kBlock * kBlock),
      ray_count_(static_cast<int>(directions.size())),
      weights_(directions.size() * padded_texels_) {
  for (int t = 0; t < texel_count_; ++t) {
    const vec3 normal = tile_direction({t % texels, t / texels}, texels);
    for (int i = 0; i < ray_count_; ++i) {
      weights_[static_cast<std::size_t>(i) * padded_texels_ + t] =
          ray_weight(normal, directions[i], cosine_exponent);
    }
  }
}

BlendMatrix::BlendMatrix(int texel_count, int ray_count, std::span<const float> columns)
    : texel_count_(texel_count),
      padded_texels_((texel_count + kBlock - 1) / kBlock * kBlock),
      ray_count_(ray_count),
      weights_(static_cast<std::size_t>(ray_count) * padded_texels_) {
  assert(columns.size() == static_cast<std::size_t>(texel_count) * ray_count);
  for (int i = 0; i < ray_count; ++i) {
    std::copy_n(&columns[static_cast<std::size_t>(i) * texel_count], texel_count,
                &weights_[static_cast<std::size_t>(i) * padded_texels_]);
  }
}

void BlendMatrix::apply2(const float* values, float* sums) const {
  apply<2>(weights_, padded_texels_, texel_count_, ray_count_, values, sums, accumulate2);
}

void BlendMatrix::apply4(const float* values, float* sums) const {
  apply<4>(weights_, padded_texels_, texel_count_, ray_count_, values, sums, accumulate4);
}

}  // namespace lambent
