// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/image/flip.h"
#include "core/image/mid_grey.h"
#include "core/image/ssim.h"
#include "shared/color.h"

namespace lambent {
namespace {

/// PSNR's white for linear radiance is this quantile of B's numbers, so that a lamp or a firefly
/// does not inflate PSNR.
constexpr double kPeakPercentile = 0.999;
constexpr int kMaxColorChannels = 3;

std::string shape(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

/// The first `channels` channels (alpha dropped, grey repeated).
Image with_channels(const Image& image, int channels) {
  Image result(image.width, image.height, channels);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < channels; ++c) {
        result.at(x, y)[c] = image.at(x, y)[std::min(c, image.channels - 1)];
      }
    }
  }
  return result;
}

/// Means of valid pixels over blocks; `counts` has the number of pixels in each.
struct Blocks {
  Image means;
  std::vector<int> counts;
};

Blocks block_means(const Image& image, const std::vector<char>& valid, int block) {
  const int width = (image.width + block - 1) / block, height = (image.height + block - 1) / block;
  Blocks blocks{Image(width, height, image.channels),
                std::vector<int>(static_cast<std::size_t>(width) * height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sums[kMaxColorChannels] = {};
      int count = 0;
      for (int v = y * block; v < std::min((y + 1) * block, image.height); ++v) {
        for (int u = x * block; u < std::min((x + 1) * block, image.width); ++u) {
          if (!valid[static_cast<std::size_t>(v) * image.width + u]) continue;
          for (int c = 0; c < image.channels; ++c) sums[c] += image.at(u, v)[c];
          ++count;
        }
      }
      blocks.counts[static_cast<std::size_t>(y) * width + x] = count;
      for (int c = 0; c < image.channels && count > 0; ++c) {
        blocks.means.at(x, y)[c] = static_cast<float>(sums[c] / count);
      }
    }
  }
  return blocks;
}

/// rmse, relmse and max_error over blocks; blocks without a valid pixel do not count.
void add_squared_errors(const Blocks& a, const Blocks& b, Metrics& metrics) {
  const std::size_t channels = static_cast<std::size_t>(a.means.channels);
  double squares = 0.0, relative_squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.counts.size(); ++i) {
    if (a.counts[i] == 0) continue;
    for (std::size_t c = i * channels; c < (i + 1) * channels; ++c) {
      const double reference = b.means.pixels[c];
      const double error = a.means.pixels[c] - reference;
      squares += error * error;
      relative_squares += error * error / (reference * reference + kRelMseEpsilon);
      metrics.max_error = std::max(metrics.max_error, std::abs(error));
    }
    count += channels;
  }
  metrics.rmse = std::sqrt(squares / static_cast<double>(count));
  metrics.relmse = relative_squares / static_cast<double>(count);
}

/// The luminance of each block, or its mean where the image has one or two channels; NaN for blocks
/// without a pixel.
std::vector<double> block_luminance(const Blocks& blocks) {
  std::vector<double> result(blocks.counts.size(), std::numeric_limits<double>::quiet_NaN());
  const int channels = blocks.means.channels;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (blocks.counts[i] == 0) continue;
    const float* p = blocks.means.pixels.data() + i * static_cast<std::size_t>(channels);
    result[i] = channels == 3 ? luminance(vec3(p[0], p[1], p[2])) : p[0];
  }
  return result;
}

/// Mean over blocks of the variance of B's block means, from its standard error per pixel.
double mean_block_variance(const Image& standard_error, const std::vector<char>& valid, int block) {
  Image variance = standard_error;
  for (float& value : variance.pixels) value = std::isfinite(value) ? value * value : 0.0f;
  const Blocks blocks = block_means(variance, valid, block);
  const std::size_t channels = static_cast<std::size_t>(variance.channels);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks.counts.size(); ++i) {
    if (blocks.counts[i] == 0) continue;
    for (std::size_t c = i * channels; c < (i + 1) * channels; ++c) {
      sum += static_cast<double>(blocks.means.pixels[c]) / blocks.counts[i];
    }
    count += channels;
  }
  return sum / static_cast<double>(count);
}

double mean_of_valid(const Image& image, const std::vector<char>& valid) {
  const std::size_t channels = static_cast<std::size_t>(image.channels);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (!valid[i]) continue;
    for (std::size_t c = i * channels; c < (i + 1) * channels; ++c) sum += image.pixels[c];
    count += channels;
  }
  return sum / static_cast<double>(count);
}

double percentile(const Image& image, double share) {
  std::vector<float> values = image.pixels;
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

/// sRGB-encoded luminance, one channel.
Image encoded_luminance(const Image& rgb) {
  Image result(rgb.width, rgb.height, 1);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const float* p = rgb.pixels.data() + 3 * i;
    result.pixels[i] = srgb_from_linear(luminance(vec3(p[0], p[1], p[2])));
  }
  return result;
}

void add_perceptual(const ImagePair& pair, bool display, Metrics& metrics) {
  metrics.exposure = display ? 1.0 : auto_exposure(pair.b);
  const Image a = clipped_rgb(pair.a, metrics.exposure), b = clipped_rgb(pair.b, metrics.exposure);
  metrics.ssim = mean_of_valid(ssim(encoded_luminance(a), encoded_luminance(b)), pair.valid);
  metrics.flip = mean_of_valid(flip(a, b), pair.valid);
  if (display) return;
  const Image linear_a = with_channels(pair.a, 3), linear_b = with_channels(pair.b, 3);
  metrics.hdr_flip = mean_of_valid(hdr_flip(linear_a, linear_b), pair.valid);
}

}  // namespace

Expected<ImagePair> match_images(const Image& a, const Image& b, double scale) {
  if (a.width != b.width || a.height != b.height) {
    return fail("", "", "the images differ in size: " + shape(a) + " and " + shape(b));
  }
  if (a.empty() || b.empty()) return fail("", "", "an image without pixels has nothing to compare");
  const int channels_a = std::min(a.channels, kMaxColorChannels);
  const int channels_b = std::min(b.channels, kMaxColorChannels);
  if (channels_a != channels_b && channels_a != 1 && channels_b != 1) {
    return fail("", "",
                "the images differ in channels: " + std::to_string(a.channels) + " and " +
                    std::to_string(b.channels));
  }
  const int channels = std::max(channels_a, channels_b);
  ImagePair pair{with_channels(a, channels), with_channels(b, channels), {}};
  const std::size_t pixels = pair.a.pixels.size() / static_cast<std::size_t>(channels);
  pair.valid.assign(pixels, 1);
  for (std::size_t i = 0; i < pair.a.pixels.size(); ++i) {
    pair.a.pixels[i] = static_cast<float>(scale * pair.a.pixels[i]);
    const bool finite = std::isfinite(pair.a.pixels[i]) && std::isfinite(pair.b.pixels[i]);
    if (!finite) pair.valid[i / static_cast<std::size_t>(channels)] = 0;
  }
  for (std::size_t i = 0; i < pair.a.pixels.size(); ++i) {
    if (!pair.valid[i / static_cast<std::size_t>(channels)])
      pair.a.pixels[i] = pair.b.pixels[i] = 0.0f;
  }
  return pair;
}

Image clipped_rgb(const Image& image, double exposure) {
  Image result = with_channels(image, 3);
  for (float& value : result.pixels) {
    value = static_cast<float>(std::clamp(exposure * value, 0.0, 1.0));
  }
  return result;
}

double auto_exposure(const Image& image) {
  const Image rgb = with_channels(image, 3);
  double log_sum = 0.0;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < rgb.pixels.size(); i += 3) {
    const float value = luminance(vec3(rgb.pixels[i], rgb.pixels[i + 1], rgb.pixels[i + 2]));
    if (!(value > 0.0f) || !std::isfinite(value)) continue;
    log_sum += std::log(static_cast<double>(value));
    ++lit;
  }
  return lit == 0 ? 1.0 : kMidGrey / std::exp(log_sum / static_cast<double>(lit));
}

Expected<Metrics> compare_images(const Image& a, const Image& b, const MetricsOptions& options) {
  const Expected<ImagePair> pair = match_images(a, b, options.scale);
  if (!pair) return tl::unexpected(pair.error());
  if (options.block < 1) return fail("", "", "blocks must be at least 1 pixel wide");

  Metrics metrics;
  metrics.pixels = static_cast<std::size_t>(std::count(pair->valid.begin(), pair->valid.end(), 1));
  metrics.excluded = pair->valid.size() - metrics.pixels;
  metrics.mean_a = mean_of_valid(pair->a, pair->valid);
  metrics.mean_b = mean_of_valid(pair->b, pair->valid);
  metrics.mean_ratio = metrics.mean_a / metrics.mean_b;
  const Blocks blocks_a = block_means(pair->a, pair->valid, options.block);
  const Blocks blocks_b = block_means(pair->b, pair->valid, options.block);
  add_squared_errors(blocks_a, blocks_b, metrics);
  metrics.blocks =
      block_ratios(block_luminance(blocks_a), block_luminance(blocks_b), blocks_a.means.width);
  metrics.relative_rmse = metrics.rmse / metrics.mean_b;

  if (options.standard_error != nullptr) {
    const Image& se = *options.standard_error;
    if (se.width != b.width || se.height != b.height || se.channels < pair->b.channels) {
      return fail("", "",
                  "the standard error (" + shape(se) + ", " + std::to_string(se.channels) +
                      " channels) does not fit the reference (" + shape(b) + ", " +
                      std::to_string(pair->b.channels) + ")");
    }
    const double variance =
        mean_block_variance(with_channels(se, pair->b.channels), pair->valid, options.block);
    const double own_square = std::max(0.0, metrics.rmse * metrics.rmse - variance);
    metrics.noise_corrected_relative_rmse = std::sqrt(own_square) / metrics.mean_b;
  }

  metrics.peak = options.display ? 1.0 : percentile(pair->b, kPeakPercentile);
  metrics.psnr_db = 20.0 * std::log10(metrics.peak / metrics.rmse);
  if (options.perceptual) {
    add_perceptual(*pair, options.display, metrics);
  } else {
    metrics.ssim = metrics.flip = std::numeric_limits<double>::quiet_NaN();
  }
  return metrics;
}

}  // namespace lambent
