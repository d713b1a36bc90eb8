// SPDX-License-Identifier: Apache-2.0
#include "core/image/tone_map.h"

#include <algorithm>
#include <cmath>

#include "core/image/mid_grey.h"
#include "shared/tone_map.h"

namespace lambent {

static_assert(static_cast<uint>(ToneMap::linear) == kToneMapLinear &&
              static_cast<uint>(ToneMap::aces) == kToneMapAces &&
              static_cast<uint>(ToneMap::neutral) == kToneMapNeutral);

std::optional<ToneMap> tone_map_from_name(std::string_view name) {
  if (name == "linear") return ToneMap::linear;
  if (name == "aces") return ToneMap::aces;
  if (name == "neutral") return ToneMap::neutral;
  return std::nullopt;
}

Image display_image(const Image& linear, ToneMap tone_map, float exposure_stops) {
  const bool grey = linear.channels < 3;
  const bool alpha = linear.channels == 4;
  const auto number = [](float value) { return std::isnan(value) ? 0.0f : value; };
  Image shown(linear.width, linear.height, alpha ? 4 : 3);
  for (int y = 0; y < linear.height; ++y) {
    for (int x = 0; x < linear.width; ++x) {
      const float* in = linear.at(x, y);
      float* out = shown.at(x, y);
      const vec3 radiance(number(in[0]), number(in[grey ? 0 : 1]), number(in[grey ? 0 : 2]));
      const vec3 color = display_from_linear(radiance, static_cast<uint>(tone_map), exposure_stops);
      for (int c = 0; c < 3; ++c) out[c] = color[c];
      if (alpha) out[3] = std::clamp(number(in[3]), 0.0f, 1.0f);
    }
  }
  return shown;
}

float radiance_of_colors(ToneMap tone_map, float exposure_stops) {
  constexpr auto grey = static_cast<float>(kMidGrey);
  // Bisect: curves are increasing, and all of them map mid-grey to between half and twice its value
  float low = 0.5f * grey, high = 2.0f * grey;
  constexpr int kHalvings = 24;  // bits of a float
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (low + high);
    const bool dark = lambent::tone_map(vec3(middle), static_cast<uint>(tone_map)).y < grey;
    (dark ? low : high) = middle;
  }
  return std::clamp(high / grey * std::exp2(-exposure_stops), 1e-10f, 1e10f);
}

}  // namespace lambent
