// SPDX-License-Identifier: Apache-2.0
// Based on: Andersson, Nilsson, Shirley, Akenine-Moeller, "Visualizing Errors in Rendered High
// Dynamic Range Images", Eurographics short papers, 2021.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/image/flip.h"
#include "shared/color.h"

namespace lambent {
namespace {

/// Narkowicz, "ACES Filmic Tone Mapping Curve", 2016, with its input multiplied by 0.6, as in the
/// paper: (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kPreScale = 0.6;
constexpr double kA = 2.51 * kPreScale * kPreScale, kB = 0.03 * kPreScale;
constexpr double kC = 2.43 * kPreScale * kPreScale, kD = 0.59 * kPreScale, kE = 0.14;
/// Sec. 3.1: a pixel counts as nearly white where the curve reaches this.
constexpr double kNearlyWhite = 0.85;
/// Radiance is clamped to this [W/(m^2 sr)], where the curve is white at any exposure, so that
/// squares are finite.
constexpr double kMaxRadiance = 1e8;
/// Limit of exposures, since a black reference with one bright pixel would need very many.
constexpr int kMaxExposures = 24;

float narkowicz(double value) {
  const double x = std::clamp(value, 0.0, kMaxRadiance);
  return static_cast<float>(std::min(1.0, x * (kA * x + kB) / (x * (kC * x + kD) + kE)));
}

/// The input at which the curve reaches kNearlyWhite.
double nearly_white_input() {
  const double a = kA - kNearlyWhite * kC, b = kB - kNearlyWhite * kD, c = -kNearlyWhite * kE;
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

struct ExposureRange {
  double first = 0.0, last = 0.0;  ///< Stops.
  int count = 1;
};

/// Sec. 3.1: from the exposure that makes the brightest pixel nearly white to the one that does so
/// to the median.
ExposureRange exposure_range(const Image& reference) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i + 2 < reference.pixels.size(); i += 3) {
    const float* rgb = reference.pixels.data() + i;
    const double value = luminance(vec3(rgb[0], rgb[1], rgb[2]));
    if (value > 0.0) luminances.push_back(value);
  }
  if (luminances.empty()) return {};
  std::sort(luminances.begin(), luminances.end());
  const double white = nearly_white_input();
  ExposureRange range;
  range.first = std::log2(white / luminances.back());
  range.last = std::log2(white / luminances[luminances.size() / 2]);
  const double stops = std::ceil(range.last - range.first);
  range.count = static_cast<int>(std::clamp(stops, 2.0, static_cast<double>(kMaxExposures)));
  return range;
}

Image exposed(const Image& image, double stops) {
  Image result = image;
  const double scale = std::exp2(stops);
  for (float& value : result.pixels) value = narkowicz(scale * value);
  return result;
}

}  // namespace

Image hdr_flip(const Image& test, const Image& reference, float pixels_per_degree) {
  const ExposureRange range = exposure_range(reference);
  Image largest(test.width, test.height, 1);
  for (int i = 0; i < range.count; ++i) {
    const double share = range.count > 1 ? static_cast<double>(i) / (range.count - 1) : 0.0;
    const double stops = range.first + share * (range.last - range.first);
    const Image map = flip(exposed(test, stops), exposed(reference, stops), pixels_per_degree);
    for (std::size_t p = 0; p < map.pixels.size(); ++p) {
      largest.pixels[p] = std::max(largest.pixels[p], map.pixels[p]);
    }
  }
  return largest;
}

}  // namespace lambent
