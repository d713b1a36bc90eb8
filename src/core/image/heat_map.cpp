// SPDX-License-Identifier: Apache-2.0
#include "core/image/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>

#include "core/image/color_map.h"
#include "core/image/flip.h"
#include "shared/color.h"

namespace lambent {
namespace {

using ColorOf = std::function<glm::vec3(float)>;

/// Panels are enlarged by integer factors until they are this wide [pixels], so that labels fit and
/// pixels are visible.
constexpr int kMinPanelWidth = 256;
/// Enlarged panels are at most this high [pixels]: a narrow column would grow to gigabytes.
constexpr int kMaxEnlargedHeight = 4096;
constexpr int kMargin = 8;
constexpr int kLegendBar = 12;
constexpr int kGlyphScale = 2, kGlyphWidth = 3, kGlyphHeight = 5;
constexpr int kLegendHeight = kLegendBar + 3 * kMargin + kGlyphScale * kGlyphHeight;
/// Where B is darker than this share of its mean, errors are relative to this share of the mean;
/// otherwise black pixels would have infinite relative errors.
constexpr float kDarkShare = 0.1f;

const glm::vec3 kBackground(1.0f), kInk(0.1f), kNotFinite(1.0f, 0.0f, 1.0f);

/// A glyph of 3x5 dots, rows from the top, three bits a row.
struct Glyph {
  char character;
  std::array<int, kGlyphHeight> rows;
};
constexpr Glyph kGlyphs[] = {
    {'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}}, {'2', {7, 1, 7, 4, 7}}, {'3', {7, 1, 7, 1, 7}},
    {'4', {5, 5, 7, 1, 1}}, {'5', {7, 4, 7, 1, 7}}, {'6', {7, 4, 7, 5, 7}}, {'7', {7, 1, 1, 1, 1}},
    {'8', {7, 5, 7, 5, 7}}, {'9', {7, 5, 7, 1, 7}}, {'-', {0, 0, 7, 0, 0}}, {'+', {0, 2, 7, 2, 0}},
    {'%', {5, 1, 2, 4, 5}}, {'.', {0, 0, 0, 0, 2}},
};

void set_pixel(Image& image, int x, int y, const glm::vec3& color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  for (int c = 0; c < 3; ++c) image.at(x, y)[c] = color[c];
}

void fill(Image& image, int x0, int y0, int width, int height, const glm::vec3& color) {
  for (int y = y0; y < y0 + height; ++y) {
    for (int x = x0; x < x0 + width; ++x) set_pixel(image, x, y, color);
  }
}

Image blank(int width, int height) {
  Image image(width, height, 3);
  fill(image, 0, 0, width, height, kBackground);
  return image;
}

void draw_text(Image& image, int x, int y, std::string_view text) {
  for (const char character : text) {
    for (const Glyph& glyph : kGlyphs) {
      if (glyph.character != character) continue;
      for (int row = 0; row < kGlyphHeight; ++row) {
        for (int column = 0; column < kGlyphWidth; ++column) {
          const int bits = glyph.rows[static_cast<std::size_t>(row)];
          if (((bits >> (kGlyphWidth - 1 - column)) & 1) == 0) continue;
          fill(image, x + column * kGlyphScale, y + row * kGlyphScale, kGlyphScale, kGlyphScale,
               kInk);
        }
      }
    }
    x += (kGlyphWidth + 1) * kGlyphScale;
  }
}

int text_width(std::string_view text) {
  return static_cast<int>(text.size()) * (kGlyphWidth + 1) * kGlyphScale - kGlyphScale;
}

/// The contents of a panel: one value per pixel, the colour map, and the legend's ends and middle.
struct Panel {
  Image values;  ///< One channel.
  ColorOf color_of;
  float low, high;
  std::array<std::string_view, 3> labels;
};

void draw_panel(Image& picture, int left, const Panel& panel, const std::vector<char>& valid,
                int zoom) {
  for (int y = 0; y < panel.values.height; ++y) {
    for (int x = 0; x < panel.values.width; ++x) {
      const bool finite = valid[static_cast<std::size_t>(y) * panel.values.width + x] != 0;
      fill(picture, left + x * zoom, kMargin + y * zoom, zoom, zoom,
           finite ? panel.color_of(panel.values.at(x, y)[0]) : kNotFinite);
    }
  }

  // Draw the legend: the colours from low to high, and labels under both ends and the middle.
  const int width = panel.values.width * zoom;
  const int bar_top = kMargin + panel.values.height * zoom + kMargin;
  for (int x = 0; x < width; ++x) {
    const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
    fill(picture, left + x, bar_top, 1, kLegendBar,
         panel.color_of(panel.low + share * (panel.high - panel.low)));
  }
  const int text_top = bar_top + kLegendBar + kMargin / 2;
  for (int i = 0; i < 3; ++i) {
    const std::string_view label = panel.labels[static_cast<std::size_t>(i)];
    draw_text(picture, left + i * (width - text_width(label)) / 2, text_top, label);
  }
}

float luminance_at(const Image& rgb, std::size_t pixel) {
  const float* p = rgb.pixels.data() + 3 * pixel;
  return luminance(vec3(p[0], p[1], p[2]));
}

Image as_rgb(const Image& image) {
  Image rgb(image.width, image.height, 3);
  for (std::size_t i = 0; i < rgb.pixels.size(); ++i) {
    const std::size_t pixel = i / 3, channel = i % 3;
    const std::size_t channels = static_cast<std::size_t>(image.channels);
    rgb.pixels[i] = image.pixels[pixel * channels + std::min(channel, channels - 1)];
  }
  return rgb;
}

Image relative_errors(const ImagePair& pair) {
  const Image a = as_rgb(pair.a), b = as_rgb(pair.b);
  Image errors(a.width, a.height, 1);
  double sum = 0.0;
  for (std::size_t i = 0; i < errors.pixels.size(); ++i) sum += std::abs(luminance_at(b, i));
  const float floor =
      kDarkShare * static_cast<float>(sum / static_cast<double>(errors.pixels.size()));
  for (std::size_t i = 0; i < errors.pixels.size(); ++i) {
    const float reference = luminance_at(b, i);
    const float difference = luminance_at(a, i) - reference;
    // Where all of B is black, light counts as an infinite error.
    const float scale = std::max(std::abs(reference), floor);
    errors.pixels[i] = difference == 0.0f ? 0.0f : difference / scale;
  }
  return errors;
}

}  // namespace

Image heat_map(const ImagePair& pair, bool display) {
  const double exposure = display ? 1.0 : auto_exposure(pair.b);
  const Panel relative{relative_errors(pair),
                       [](float value) { return diverging_color(value / kHeatMapRange); },
                       -kHeatMapRange,
                       kHeatMapRange,
                       {"-50%", "0", "+50%"}};
  const Panel perceived{flip(clipped_rgb(pair.a, exposure), clipped_rgb(pair.b, exposure)),
                        sequential_color,
                        0.0f,
                        1.0f,
                        {"0", "0.5", "1"}};
  const int zoom = std::clamp((kMinPanelWidth + pair.b.width - 1) / pair.b.width, 1,
                              std::max(1, kMaxEnlargedHeight / pair.b.height));
  const int panel_width = pair.b.width * zoom;
  Image picture =
      blank(2 * panel_width + 3 * kMargin, pair.b.height * zoom + kMargin + kLegendHeight);
  draw_panel(picture, kMargin, relative, pair.valid, zoom);
  draw_panel(picture, panel_width + 2 * kMargin, perceived, pair.valid, zoom);
  return picture;
}

Image stack(const std::vector<Image>& pictures) {
  int width = 0, height = 0;
  for (const Image& picture : pictures) {
    width = std::max(width, picture.width);
    height += picture.height;
  }
  Image result = blank(width, height);
  int top = 0;
  for (const Image& picture : pictures) {
    for (int y = 0; y < picture.height; ++y) {
      std::copy_n(picture.at(0, y), static_cast<std::size_t>(picture.width) * 3,
                  result.at(0, top + y));
    }
    top += picture.height;
  }
  return result;
}

}  // namespace lambent
