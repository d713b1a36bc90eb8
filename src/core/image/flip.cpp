// SPDX-License-Identifier: Apache-2.0
// Based on: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", PACM CGIT 3(2), 2020; Andersson, Nilsson, Shirley,
// Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics short
// papers, 2021. Written from the papers.
#include "core/image/flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/image/convolve.h"
#include "core/parallel.h"
#include "shared/color.h"
#include "shared/constants.h"

namespace lambent {
namespace {

/// Pixels that one thread works on at a time.
constexpr std::size_t kPixelsPerChunk = 4096;

/// body(i) for every pixel, on all cores.
template <class Body>
void for_each_pixel(std::size_t count, const Body& body) {
  parallel_chunks(count, kPixelsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Rows of the matrix from linear Rec. 709 to CIE XYZ (IEC 61966-2-1, D65).
const vec3 kXFromLinear(0.4124564f, 0.3575761f, 0.1804375f);
const vec3 kYFromLinear(0.2126729f, 0.7151522f, 0.0721750f);
const vec3 kZFromLinear(0.0193339f, 0.1191920f, 0.9503041f);
/// XYZ of white: the sums of those rows.
const vec3 kWhite(0.9504700f, 1.0000001f, 1.0888300f);

vec3 xyz_from_linear(const vec3& linear) {
  return vec3(dot(kXFromLinear, linear), dot(kYFromLinear, linear), dot(kZFromLinear, linear));
}

vec3 linear_from_xyz(const vec3& xyz) {
  static const mat3 kInverse =
      glm::inverse(glm::transpose(mat3(kXFromLinear, kYFromLinear, kZFromLinear)));
  return kInverse * xyz;
}

/// CIE 15: scales of CIELAB, and the offset of its lightness.
constexpr float kLabLightness = 116.0f, kLabBlack = 16.0f, kLabA = 500.0f, kLabB = 200.0f;
/// Largest lightness: that of white.
constexpr float kLabWhite = 100.0f;
/// Radius of Gaussian filters [standard deviations].
constexpr float kGaussianReach = 3.0f;

/// Sec. 4.1: the linearised CIELAB in which the eye's contrast sensitivity is modelled.
vec3 opponent_from_linear(const vec3& linear) {
  const vec3 v = xyz_from_linear(linear) / kWhite;
  return vec3(kLabLightness * v.y - kLabBlack, kLabA * (v.x - v.y), kLabB * (v.y - v.z));
}

vec3 linear_from_opponent(const vec3& opponent) {
  const float y = (opponent.x + kLabBlack) / kLabLightness;
  return linear_from_xyz(vec3(y + opponent.y / kLabA, y, y - opponent.z / kLabB) * kWhite);
}

/// CIE 15: the cube root with its linear toe.
float lab_curve(float t) {
  constexpr float kToe = 6.0f / 29.0f;
  return t > kToe * kToe * kToe ? std::cbrt(t) : t / (3.0f * kToe * kToe) + 4.0f / 29.0f;
}

/// Sec. 4.1.2: CIELAB whose chroma fades with lightness (the Hunt effect).
vec3 hunt_lab_from_linear(const vec3& linear) {
  const vec3 v = xyz_from_linear(linear) / kWhite;
  const vec3 f(lab_curve(v.x), lab_curve(v.y), lab_curve(v.z));
  const float lightness = kLabLightness * f.y - kLabBlack;
  const float share_of_white = lightness / kLabWhite;
  return vec3(lightness, share_of_white * kLabA * (f.x - f.y),
              share_of_white * kLabB * (f.y - f.z));
}

/// Abasi et al. 2020: HyAB, a colour distance that is also valid for large differences.
float hyab(const vec3& a, const vec3& b) {
  const vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

/// Compresses large colour differences, which people do not grade. Sec. 4.1.3.
constexpr float kColorExponent = 0.7f;
/// Differences up to this share of the largest get `kLinearTarget` of the range [0, 1].
constexpr float kLinearShare = 0.4f;
constexpr float kLinearTarget = 0.95f;
/// Sec. 4.2: width of the feature detector [degrees], and the exponent on feature differences.
constexpr float kFeatureWidth = 0.082f;
constexpr float kFeatureExponent = 0.5f;

/// Table 1: contrast sensitivity of one opponent channel, as two Gaussians in the spatial domain.
struct Sensitivity {
  float a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic = {1.0f, 0.0047f, 0.0f, 1e-5f};
constexpr Sensitivity kRedGreen = {1.0f, 0.0053f, 0.0f, 1e-5f};
constexpr Sensitivity kBlueYellow = {34.1f, 0.04f, 13.5f, 0.025f};

/// Standard deviation [pixels] of a Gaussian of Table 1.
float sensitivity_sigma(float b, float pixels_per_degree) {
  return std::sqrt(b / (2.0f * kPi * kPi)) * pixels_per_degree;
}

/// One opponent channel, filtered by the eye's contrast sensitivity. A sum of two Gaussians in 2D
/// is two separable filters, weighted by their volumes on the pixel grid.
Image filter_channel(const Image& channel, const Sensitivity& csf, float pixels_per_degree) {
  const int radius = static_cast<int>(
      std::ceil(kGaussianReach * sensitivity_sigma(kBlueYellow.b1, pixels_per_degree)));
  const auto volume = [&](float a, float b) {
    const float sigma = sensitivity_sigma(b, pixels_per_degree);
    float line = 0.0f;
    for (int x = -radius; x <= radius; ++x) {
      line += std::exp(-0.5f * static_cast<float>(x * x) / (sigma * sigma));
    }
    return a * std::sqrt(kPi / b) * line * line;
  };
  const Kernel first = gaussian_kernel(sensitivity_sigma(csf.b1, pixels_per_degree), radius);
  Image filtered = convolve(channel, first, first);
  if (csf.a2 == 0.0f) return filtered;

  const Kernel second = gaussian_kernel(sensitivity_sigma(csf.b2, pixels_per_degree), radius);
  const Image other = convolve(channel, second, second);
  const float v1 = volume(csf.a1, csf.b1), v2 = volume(csf.a2, csf.b2);
  for (std::size_t i = 0; i < filtered.pixels.size(); ++i) {
    filtered.pixels[i] = (v1 * filtered.pixels[i] + v2 * other.pixels[i]) / (v1 + v2);
  }
  return filtered;
}

/// The three opponent channels of a linear RGB image.
struct Opponent {
  Image achromatic, red_green, blue_yellow;
};

Opponent split_opponent(const Image& linear) {
  Opponent split{Image(linear.width, linear.height, 1), Image(linear.width, linear.height, 1),
                 Image(linear.width, linear.height, 1)};
  for (std::size_t i = 0; i < split.achromatic.pixels.size(); ++i) {
    const float* rgb = linear.pixels.data() + 3 * i;
    const vec3 opponent = opponent_from_linear(vec3(rgb[0], rgb[1], rgb[2]));
    split.achromatic.pixels[i] = opponent.x;
    split.red_green.pixels[i] = opponent.y;
    split.blue_yellow.pixels[i] = opponent.z;
  }
  return split;
}

/// Sec. 4.1: colours as seen from the viewing distance, in Hunt-adjusted CIELAB.
std::vector<vec3> perceived_colors(const Opponent& split, float pixels_per_degree) {
  const Image a = filter_channel(split.achromatic, kAchromatic, pixels_per_degree);
  const Image rg = filter_channel(split.red_green, kRedGreen, pixels_per_degree);
  const Image by = filter_channel(split.blue_yellow, kBlueYellow, pixels_per_degree);
  std::vector<vec3> colors(a.pixels.size());
  for_each_pixel(colors.size(), [&](std::size_t i) {
    const vec3 linear = linear_from_opponent(vec3(a.pixels[i], rg.pixels[i], by.pixels[i]));
    colors[i] = hunt_lab_from_linear(clamp(linear, vec3(0.0f), vec3(1.0f)));
  });
  return colors;
}

/// Derivatives of a Gaussian, positive and negative weights scaled to sum +1 and -1. Sec. 4.2.
Kernel feature_kernel(int order, float sigma, int radius) {
  Kernel kernel{radius, {}};
  float positive = 0.0f, negative = 0.0f;
  for (int i = -radius; i <= radius; ++i) {
    const float x = static_cast<float>(i);
    const float polynomial = order == 1 ? -x : x * x / (sigma * sigma) - 1.0f;
    const float tap = polynomial * std::exp(-0.5f * x * x / (sigma * sigma));
    (tap > 0.0f ? positive : negative) += std::abs(tap);
    kernel.taps.push_back(tap);
  }
  for (float& tap : kernel.taps) tap /= tap > 0.0f ? positive : negative;
  return kernel;
}

/// Strength of edges (order 1) or points (order 2) of an achromatic channel.
Image feature_strength(const Image& achromatic, int order, float pixels_per_degree) {
  const float sigma = 0.5f * kFeatureWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(kGaussianReach * sigma));
  const Kernel smooth = gaussian_kernel(sigma, radius);
  const Kernel derivative = feature_kernel(order, sigma, radius);
  Image dx = convolve(achromatic, derivative, smooth);
  const Image dy = convolve(achromatic, smooth, derivative);
  for (std::size_t i = 0; i < dx.pixels.size(); ++i) {
    dx.pixels[i] = std::hypot(dx.pixels[i], dy.pixels[i]);
  }
  return dx;
}

/// Sec. 4.1.3: maps a colour difference of any size to [0, 1].
float redistribute(float difference, float largest) {
  const float limit = kLinearShare * largest;
  if (difference < limit) return kLinearTarget / limit * difference;
  return kLinearTarget + (difference - limit) / (largest - limit) * (1.0f - kLinearTarget);
}

Image normalised_achromatic(Image achromatic) {
  for (float& value : achromatic.pixels) value = (value + kLabBlack) / kLabLightness;
  return achromatic;
}

}  // namespace

Image flip(const Image& test, const Image& reference, float pixels_per_degree) {
  assert(test.width == reference.width && test.height == reference.height);
  assert(test.channels == 3 && reference.channels == 3);
  const Opponent split_test = split_opponent(test), split_reference = split_opponent(reference);
  const std::vector<vec3> seen_test = perceived_colors(split_test, pixels_per_degree);
  const std::vector<vec3> seen_reference = perceived_colors(split_reference, pixels_per_degree);

  const Image grey_test = normalised_achromatic(split_test.achromatic);
  const Image grey_reference = normalised_achromatic(split_reference.achromatic);
  const Image edges_test = feature_strength(grey_test, 1, pixels_per_degree);
  const Image edges_reference = feature_strength(grey_reference, 1, pixels_per_degree);
  const Image points_test = feature_strength(grey_test, 2, pixels_per_degree);
  const Image points_reference = feature_strength(grey_reference, 2, pixels_per_degree);

  // Green and blue have the largest difference in Rec. 709.
  const float largest = std::pow(hyab(hunt_lab_from_linear(vec3(0.0f, 1.0f, 0.0f)),
                                      hunt_lab_from_linear(vec3(0.0f, 0.0f, 1.0f))),
                                 kColorExponent);
  Image result(test.width, test.height, 1);
  for_each_pixel(result.pixels.size(), [&](std::size_t i) {
    const float distance = hyab(seen_test[i], seen_reference[i]);
    const float color = redistribute(std::pow(distance, kColorExponent), largest);
    const float edge = std::abs(edges_reference.pixels[i] - edges_test.pixels[i]);
    const float point = std::abs(points_reference.pixels[i] - points_test.pixels[i]);
    const float feature = std::pow(std::max(edge, point) / std::sqrt(2.0f), kFeatureExponent);
    // Sec. 4.3: a feature that appears or vanishes increases the colour difference.
    result.pixels[i] = std::pow(color, 1.0f - std::min(feature, 1.0f));
  });
  return result;
}

}  // namespace lambent
