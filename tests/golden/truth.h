// SPDX-License-Identifier: Apache-2.0
// Images of an independent path tracer, one file a pass, and how ours are judged against them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "lambent/image.h"

namespace lambent::test {

/// Where truth images and real scenes lie, where a developer has them.
inline std::filesystem::path shared_dir() {
  return LAMBENT_SHARED_DIR;
}

/// Samples a pixel of tests against the truth: few, so that they are quick, unless the environment
/// asks for more.
inline int truth_samples(int quick) {
  const char* asked = std::getenv("LAMBENT_TRUTH_SAMPLES");
  return asked != nullptr ? std::max(2, std::atoi(asked)) : quick;
}

/// Per-pixel values and their variances, 3 channels.
struct Estimated {
  int width = 0, height = 0;
  std::vector<double> value, variance;
};

/// Channel `k` of a pixel; a single channel stands for all.
inline double channel(const Image& image, std::size_t pixel, int k) {
  return image.pixels[pixel * image.channels + std::min(k, image.channels - 1)];
}

/// The first three channels of an image, and of its error where there is one.
inline Estimated from_image(const Image& image, const Image* error) {
  Estimated result{image.width, image.height, {}, {}};
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  for (std::size_t p = 0; p < pixels; ++p) {
    for (int k = 0; k < 3; ++k) {
      const double se = error != nullptr ? channel(*error, p, k) : 0.0;
      result.value.push_back(channel(image, p, k));
      result.variance.push_back(se * se);
    }
  }
  return result;
}

/// A pass of a set ("DiffInd"), with its standard error where there is one. Asserts nothing: empty
/// where missing.
inline Estimated read_truth(const std::string& set, const std::string& pass) {
  const std::string stem = (shared_dir() / "truth" / set / set).string() + "." + pass;
  const auto value = read_image(stem + ".exr");
  const auto error = read_image(stem + "_se.exr");
  if (!value || value->layers.empty()) return {};
  return from_image(value->layers[0].image, error ? &error->layers[0].image : nullptr);
}

/// A layer of ours with its error.
inline Estimated layer_of(const LayeredImage& image, const std::string& name) {
  return from_image(*image.find(name), image.find(name.empty() ? "error" : name + ".error"));
}

inline Estimated operator+(Estimated a, const Estimated& b) {
  for (std::size_t i = 0; i < a.value.size(); ++i) {
    a.value[i] += b.value[i];
    a.variance[i] += b.variance[i];
  }
  return a;
}

/// Product with what has no noise to speak of (an albedo).
inline Estimated operator*(Estimated a, const Estimated& exact) {
  for (std::size_t i = 0; i < a.value.size(); ++i) {
    a.value[i] *= exact.value[i];
    a.variance[i] *= exact.value[i] * exact.value[i];
  }
  return a;
}

/// How an image agrees with the truth.
struct Agreement {
  double mean_ratio = 0.0;
  double mean_ratio_error = 0.0;  ///< Standard error of the ratio, of both images' noise.
  double median_deviation =
      0.0;  ///< Of block means, in standard errors: 0.67 where there is noise alone.
  double outlier_share = 0.0;  ///< Of blocks that are off by more than kOutlier standard errors.
};

constexpr int kBlock = 8;         // pixels: block means hide per-pixel noise and keep structure
constexpr double kOutlier = 4.0;  // standard errors; noise alone passes it once in 16,000 blocks

/// Compares means, and means of blocks in units of their noise, of which `model_error` (relative)
/// is a part: what is known to differ between the renderers.
inline Agreement compare(const Estimated& ours, const Estimated& truth, double model_error) {
  double sum = 0.0, truth_sum = 0.0, variance = 0.0;
  std::vector<double> deviations;
  for (int by = 0; by + kBlock <= ours.height; by += kBlock) {
    for (int bx = 0; bx + kBlock <= ours.width; bx += kBlock) {
      double o = 0.0, t = 0.0, v = 0.0;
      for (int y = by; y < by + kBlock; ++y) {
        for (int c = 0; c < kBlock * 3; ++c) {
          const std::size_t i = (static_cast<std::size_t>(y) * ours.width + bx) * 3 + c;
          o += ours.value[i];
          t += truth.value[i];
          v += 3.0 * (ours.variance[i] + truth.variance[i]);  // channels share their noise
        }
      }
      sum += o;
      truth_sum += t;
      variance += v;
      const double scale = std::sqrt(v + std::pow(model_error * t, 2.0));
      if (scale > 0.0) deviations.push_back(std::abs(o - t) / scale);
    }
  }
  Agreement result;
  result.mean_ratio = sum / truth_sum;
  result.mean_ratio_error = std::sqrt(variance) / truth_sum;
  if (deviations.empty()) return result;
  std::sort(deviations.begin(), deviations.end());
  result.median_deviation = deviations[deviations.size() / 2];
  result.outlier_share = static_cast<double>(std::count_if(deviations.begin(), deviations.end(),
                                                           [](double d) { return d > kOutlier; })) /
                         static_cast<double>(deviations.size());
  return result;
}

inline void print(const std::string& set, const std::string& layer, const Agreement& a) {
  std::printf("%-16s %-10s ratio %.4f +- %.4f, median deviation %.2f, outliers %.2f %%\n",
              set.c_str(), layer.c_str(), a.mean_ratio, a.mean_ratio_error, a.median_deviation,
              100.0 * a.outlier_share);
}

}  // namespace lambent::test
