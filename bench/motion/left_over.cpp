// SPDX-License-Identifier: Apache-2.0
#include "bench/motion/left_over.h"

#include <algorithm>

namespace lambent::motion {
namespace {

float luminance_at(const Image& image, int x, int y) {
  const float* p = image.at(x, y);
  return 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
}

/// Whether the light of a pixel differs from that of its neighbours: excess light there is the edge
/// of something bright, not a ghost.
bool is_near_edge(const Image& truth, int x, int y, float step) {
  float least = luminance_at(truth, x, y), most = least;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const float there = luminance_at(truth, std::clamp(x + dx, 0, truth.width - 1),
                                       std::clamp(y + dy, 0, truth.height - 1));
      least = std::min(least, there);
      most = std::max(most, there);
    }
  }
  return most - least > step;
}

}  // namespace

Left left_over(const Image& then, const Image& now, const Image& truth) {
  double too_much = 0.0, was_too_much = 0.0;
  Left left;
  float brightest = 0.0f;
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      brightest = std::max(brightest, luminance_at(then, x, y) - luminance_at(truth, x, y));
    }
  }
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      const float should = luminance_at(truth, x, y);
      const float before = luminance_at(then, x, y) - should;
      if (before < 0.5f * brightest || is_near_edge(truth, x, y, 0.1f * brightest)) continue;
      const float after = std::max(luminance_at(now, x, y) - should, 0.0f);
      too_much += after;
      was_too_much += before;
      left.largest = std::max(left.largest, static_cast<double>(after / before));
    }
  }
  left.mean = was_too_much > 0.0 ? too_much / was_too_much : 0.0;
  return left;
}

}  // namespace lambent::motion
