// SPDX-License-Identifier: Apache-2.0
#include "core/image/tone_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/image/color_at.h"
#include "core/image/mid_grey.h"
#include "core/parallel.h"
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

namespace {

// Levels are largest channels of exposed radiance. What is brighter than this is white on a
// display, or nearly so.
constexpr float kDisplayWhite = 1.0f;
// Beside what is brighter than the first, edges begin to be steps; where it is as bright as the
// second, an eighth of it in a pixel is enough to make that white.
constexpr float kGlaring = 2.0f, kVeryGlaring = 8.0f;

// Few enough for all threads to have some of a small picture.
constexpr std::size_t kRowsPerTask = 16;

/// Exposed radiance of some rows of an image, and of those beside them.
class ExposedRows {
 public:
  ExposedRows(const Image& linear, int first, int rows, float stops, Edges edges)
      : linear_(linear),
        scale_(std::exp2(stops)),
        first_(std::max(first - 1, 0)),
        end_(std::min(first + rows + 1, linear.height)) {
    levels_.reserve(static_cast<std::size_t>(end_ - first_) * linear.width);
    for (int y = first_; y < end_; ++y) {
      for (int x = 0; x < linear.width; ++x) levels_.push_back(largest_channel(at(x, y)));
    }
    beside_glare_.assign(levels_.size(), 0);
    if (edges == Edges::as_averaged) return;
    for (int y = first_; y < end_; ++y) {
      for (int x = 0; x < linear.width; ++x) {
        if (level_at(x, y) <= kGlaring) continue;
        around(x, y, [&](int a, int b) { beside_glare_[index(a, b)] = 1; });
      }
    }
  }

  /// Finite, and not negative; NaN counts as black.
  vec3 at(int x, int y) const {
    vec3 color = scale_ * color_at(linear_, x, y);
    for (int c = 0; c < 3; ++c) {
      color[c] = std::isnan(color[c]) ? 0.0f : std::clamp(color[c], 0.0f, kToneMapMaxInput);
    }
    return color;
  }
  /// Largest channel of a pixel.
  float level_at(int x, int y) const { return levels_[index(x, y)]; }
  /// Whether a pixel, or one beside it, is brighter than kGlaring.
  bool is_beside_glare(int x, int y) const { return beside_glare_[index(x, y)] != 0; }

  /// Calls `visit` with the places of a pixel and those around it.
  template <class Visit>
  void around(int x, int y, const Visit& visit) const {
    for (int b = std::max(y - 1, first_); b <= std::min(y + 1, end_ - 1); ++b) {
      for (int a = std::max(x - 1, 0); a <= std::min(x + 1, linear_.width - 1); ++a) visit(a, b);
    }
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - first_) * linear_.width + x;
  }

  const Image& linear_;
  float scale_;
  int first_, end_;  // rows
  std::vector<float> levels_;
  std::vector<std::uint8_t> beside_glare_;
};

/// The display-linear colour of a pixel. At the edge of what is far brighter than white, light that
/// is averaged over a pixel is white even where little of the pixel is covered, and edges are
/// steps. There, what the display shows is averaged: the pixel's level between those of the
/// brightest pixel beside it and of the brightest one that is not white is the share that is
/// covered. A texel beside a lamp that is brighter than all others around it counts as covered,
/// too.
vec3 shown_at(const ExposedRows& exposed, int x, int y, uint curve) {
  const vec3 shown = tone_map(exposed.at(x, y), curve);
  if (!exposed.is_beside_glare(x, y)) return shown;
  const float level = exposed.level_at(x, y);
  glm::ivec2 bright(x, y), dark(-1);
  float bright_level = level, dark_level = -1.0f;
  exposed.around(x, y, [&](int a, int b) {
    const float other = exposed.level_at(a, b);
    if (other > bright_level) {
      bright = {a, b};
      bright_level = other;
    }
    if (other > dark_level && other <= kDisplayWhite && (a != x || b != y)) {
      dark = {a, b};
      dark_level = other;
    }
  });
  if (dark_level < 0.0f || level <= dark_level) return shown;
  const float glare = std::log2(bright_level / kGlaring) / std::log2(kVeryGlaring / kGlaring);
  const float covered = (level - dark_level) / (bright_level - dark_level);
  const vec3 edge = mix(tone_map(exposed.at(dark.x, dark.y), curve),
                        tone_map(exposed.at(bright.x, bright.y), curve), covered);
  return mix(shown, edge, std::min(glare, 1.0f));
}

}  // namespace

Image display_image(const Image& linear, ToneMap tone_map, float exposure_stops, Edges edges) {
  return display_rows(linear, 0, linear.height, tone_map, exposure_stops, edges);
}

Image display_rows(const Image& linear, int first, int rows, ToneMap tone_map, float exposure_stops,
                   Edges edges) {
  const bool alpha = linear.channels == 4;
  const ExposedRows exposed(linear, first, rows, exposure_stops, edges);
  Image shown(linear.width, rows, alpha ? 4 : 3);
  const auto show_row = [&](int y) {
    for (int x = 0; x < linear.width; ++x) {
      float* out = shown.at(x, y);
      const vec3 color =
          srgb_from_linear(shown_at(exposed, x, first + y, static_cast<uint>(tone_map)));
      for (int c = 0; c < 3; ++c) out[c] = color[c];
      if (!alpha) continue;
      const float opacity = linear.at(x, first + y)[3];
      out[3] = std::isnan(opacity) ? 0.0f : std::clamp(opacity, 0.0f, 1.0f);
    }
  };
  parallel_chunks(static_cast<std::size_t>(rows), kRowsPerTask,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t y = begin; y < end; ++y) show_row(static_cast<int>(y));
                  });
  return shown;
}

float radiance_of_colors(ToneMap tone_map, float exposure_stops) {
  constexpr auto kGrey = static_cast<float>(kMidGrey);
  // Bisect: curves are increasing, and all of them map mid-grey to between half and twice its value
  float low = 0.5f * kGrey, high = 2.0f * kGrey;
  constexpr int kHalvings = 24;  // bits of a float
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (low + high);
    const bool dark = lambent::tone_map(vec3(middle), static_cast<uint>(tone_map)).y < kGrey;
    (dark ? low : high) = middle;
  }
  return std::clamp(high / kGrey * std::exp2(-exposure_stops), 1e-10f, 1e10f);
}

}  // namespace lambent
