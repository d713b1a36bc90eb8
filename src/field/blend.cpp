// SPDX-License-Identifier: Apache-2.0
#include "field/blend.h"

#include <algorithm>
#include <cassert>

#include "core/simd.h"
#include "field/tile.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Texels that the kernel keeps in registers at a time: with 4 channels, 8 registers of 8 floats.
constexpr int kBlock = 16;

/// One block of texels: sums[c][t] = sum over rays of values[ray][c] * weights[ray][t].
template <int channels>
__attribute__((always_inline)) inline void accumulate_block(const float* weights, int stride,
                                                            const float* values, int rays,
                                                            float (&sums)[channels][kBlock]) {
  for (int c = 0; c < channels; ++c) {
    for (int t = 0; t < kBlock; ++t) sums[c][t] = 0.0f;
  }
  for (int ray = 0; ray < rays; ++ray) {
    const float* w = weights + static_cast<std::size_t>(ray) * stride;
    const float* v = values + ray * channels;
    for (int c = 0; c < channels; ++c) {
      for (int t = 0; t < kBlock; ++t) sums[c][t] += v[c] * w[t];
    }
  }
}

LAMBENT_SIMD_CLONES void accumulate2(const float* weights, int stride, const float* values,
                                     int rays, float (&sums)[2][kBlock]) {
  accumulate_block<2>(weights, stride, values, rays, sums);
}

LAMBENT_SIMD_CLONES void accumulate4(const float* weights, int stride, const float* values,
                                     int rays, float (&sums)[4][kBlock]) {
  accumulate_block<4>(weights, stride, values, rays, sums);
}

template <int channels, class Accumulate>
void apply(const std::vector<float>& weights, int padded, int texels, int rays, const float* values,
           float* out, Accumulate accumulate) {
  float sums[channels][kBlock];
  for (int first = 0; first < texels; first += kBlock) {
    accumulate(weights.data() + first, padded, values, rays, sums);
    const int count = std::min(kBlock, texels - first);
    for (int t = 0; t < count; ++t) {
      for (int c = 0; c < channels; ++c) out[(first + t) * channels + c] = sums[c][t];
    }
  }
}

}  // namespace

std::vector<vec3> probe_ray_directions(int count, uint update, uint seed) {
  RandomStream stream = make_random_stream(update, 0x52415953u, seed);
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
      const float cosine = max(0.0f, dot(normal, directions[i]));
      weights_[static_cast<std::size_t>(i) * padded_texels_ + t] =
          cosine_exponent == 1.0f ? cosine : pow(cosine, cosine_exponent);
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
