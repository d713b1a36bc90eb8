// SPDX-License-Identifier: Apache-2.0
// A wall whose light is noise, for tests of the filter.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "lambent/denoise.h"
#include "shared/random.h"

namespace lambent::test {

/// A picture of a wall one metre away whose pixels are a millimetre wide, and its light.
struct Wall {
  Wall(int w, int h) : width(w), height(h) {
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        positions.emplace_back(0.001f * static_cast<float>(x), -0.001f * static_cast<float>(y),
                               0.0f);
        normals.emplace_back(0.0f, 0.0f, 1.0f);
        depths.push_back(1.0f);
        light.emplace_back(0.0f);
      }
    }
  }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * width + x); }
  DenoiseView view() const { return {width, height, positions, normals, depths}; }
  /// Gives each pixel light(x, y, random number).
  void set_light(const std::function<vec3(int, int, float)>& lit, std::uint32_t seed = 3) {
    RandomStream random = make_random_stream(1, 2, seed);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) light[at(x, y)] = lit(x, y, next_uniform(random));
    }
  }
  std::vector<vec3> filtered(const DenoiseSettings& settings = {}) const {
    std::vector<vec3> result(light.size());
    const NoisyLight noisy{light, base, variance, levels, history_variance};
    EXPECT_TRUE(Denoiser().filter(view(), noisy, settings, result));
    return result;
  }

  int width, height;
  std::vector<vec3> positions, normals, light, base;
  std::vector<float> depths, variance, levels, history_variance;
};

// One in eight rays brings light: as noisy as a small window.
inline constexpr float kLitShare = 0.125f;
inline vec3 one_in_eight(float u) {
  return u < kLitShare ? vec3(1.0f / kLitShare, 0.5f / kLitShare, 0.25f / kLitShare) : vec3(0.0f);
}

}  // namespace lambent::test
