// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "core/image/convolve.h"
#include "core/image/flip.h"
#include "core/image/heat_map.h"
#include "core/image/ssim.h"
#include "shared/color.h"
#include "shared/random.h"

namespace lambent::metrics_test {
namespace {

Image constant(int width, int height, vec3 color) {
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = color[static_cast<int>(i % 3)];
  return image;
}

/// Uniform noise in [low, high), the same in every run.
Image noise(int width, int height, int channels, float low, float high, uint seed) {
  Image image(width, height, channels);
  RandomStream stream = make_random_stream(0u, 0u, seed);
  for (float& value : image.pixels) value = low + (high - low) * next_uniform(stream);
  return image;
}

Image plus(Image image, float offset) {
  for (float& value : image.pixels) value += offset;
  return image;
}

float mean(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += value;
  return static_cast<float>(sum / static_cast<double>(image.pixels.size()));
}

TEST(Metrics, IdenticalImagesHaveNoError) {
  const Image image = noise(40, 30, 3, 0.0f, 2.0f, 1u);
  const auto metrics = compare_images(image, image);
  ASSERT_TRUE(metrics);
  EXPECT_EQ(metrics->pixels, 1200u);
  EXPECT_EQ(metrics->mean_ratio, 1.0);
  EXPECT_EQ(metrics->rmse, 0.0);
  EXPECT_EQ(metrics->relmse, 0.0);
  EXPECT_TRUE(std::isinf(metrics->psnr_db));
  EXPECT_NEAR(metrics->ssim, 1.0, 1e-6);
  EXPECT_EQ(metrics->flip, 0.0);
  EXPECT_EQ(metrics->hdr_flip, 0.0);
}

TEST(Metrics, ConstantOffsetHasItsClosedForm) {
  const Image b = constant(32, 16, vec3(0.5f));
  MetricsOptions options;
  options.display = true;
  const auto metrics = compare_images(plus(b, 0.1f), b, options);
  ASSERT_TRUE(metrics);
  EXPECT_NEAR(metrics->mean_ratio, 1.2, 1e-6);
  EXPECT_NEAR(metrics->rmse, 0.1, 1e-6);
  EXPECT_NEAR(metrics->relative_rmse, 0.2, 1e-6);
  EXPECT_NEAR(metrics->relmse, 0.01 / (0.25 + 0.01), 1e-6);
  EXPECT_NEAR(metrics->psnr_db, 20.0, 1e-4);
  EXPECT_NEAR(metrics->max_error, 0.1, 1e-6);
  EXPECT_FALSE(metrics->hdr_flip);
}

TEST(Metrics, ScaleMultipliesTheFirstImage) {
  const Image b = noise(16, 16, 3, 0.5f, 1.0f, 2u);
  Image a = b;
  for (float& value : a.pixels) value *= 4.0f;
  MetricsOptions options;
  options.scale = 0.25;
  const auto metrics = compare_images(a, b, options);
  ASSERT_TRUE(metrics);
  EXPECT_NEAR(metrics->rmse, 0.0, 1e-7);
}

TEST(Metrics, PixelsThatAreNotFiniteAreCountedAndLeftOut) {
  const Image b = constant(8, 8, vec3(1.0f));
  Image a = plus(b, 0.5f);
  a.at(3, 3)[1] = std::numeric_limits<float>::quiet_NaN();
  a.at(4, 3)[0] = std::numeric_limits<float>::infinity();
  const auto metrics = compare_images(a, b);
  ASSERT_TRUE(metrics);
  EXPECT_EQ(metrics->excluded, 2u);
  EXPECT_EQ(metrics->pixels, 62u);
  EXPECT_NEAR(metrics->rmse, 0.5, 1e-6);
  EXPECT_TRUE(std::isfinite(metrics->ssim));
  EXPECT_TRUE(std::isfinite(metrics->flip));
}

TEST(Metrics, BlockMeansHideNoiseButNotBias) {
  const Image b = constant(64, 64, vec3(1.0f));
  const Image a = noise(64, 64, 3, 0.6f, 1.6f, 3u);  // Mean 1.1, standard deviation 1/sqrt(12).
  MetricsOptions options;
  EXPECT_NEAR(compare_images(a, b, options)->rmse, std::sqrt(0.01 + 1.0 / 12.0), 0.01);
  options.block = 8;
  EXPECT_NEAR(compare_images(a, b, options)->rmse, std::sqrt(0.01 + 1.0 / 12.0 / 64.0), 0.01);
}

TEST(Metrics, KnownNoiseOfTheReferenceIsSubtracted) {
  const Image a = constant(128, 128, vec3(1.1f));
  const Image b = noise(128, 128, 3, 0.5f, 1.5f, 4u);
  const Image standard_error = constant(128, 128, vec3(std::sqrt(1.0f / 12.0f)));
  MetricsOptions options;
  options.standard_error = &standard_error;
  for (const int block : {1, 5, 8}) {
    options.block = block;
    const auto metrics = compare_images(a, b, options);
    ASSERT_TRUE(metrics);
    EXPECT_GT(metrics->relative_rmse, 0.1);
    EXPECT_NEAR(*metrics->noise_corrected_relative_rmse, 0.1, 0.02) << "block " << block;
  }
}

TEST(Metrics, RefusesShapesThatDoNotFit) {
  const Image b = constant(8, 8, vec3(1.0f));
  EXPECT_FALSE(compare_images(Image(8, 7, 3), b));
  EXPECT_FALSE(compare_images(Image(8, 8, 2), b));
  EXPECT_FALSE(compare_images(Image(), Image()));
  const Image small_error(4, 4, 3);
  MetricsOptions options;
  options.standard_error = &small_error;
  EXPECT_FALSE(compare_images(b, b, options));
}

TEST(Metrics, GreyComparesWithColorAndAlphaDoesNotCount) {
  const Image b = constant(8, 8, vec3(0.5f));
  Image grey(8, 8, 1), alpha(8, 8, 4);
  for (float& value : grey.pixels) value = 0.5f;
  for (std::size_t i = 0; i < alpha.pixels.size(); ++i) alpha.pixels[i] = i % 4 == 3 ? 9.0f : 0.5f;
  EXPECT_EQ(compare_images(grey, b)->rmse, 0.0);
  EXPECT_EQ(compare_images(alpha, b)->rmse, 0.0);
}

TEST(Metrics, AutoExposureBringsAGreyToMidGrey) {
  EXPECT_NEAR(auto_exposure(constant(4, 4, vec3(36.0f))), 0.005, 1e-6);
  EXPECT_EQ(auto_exposure(constant(4, 4, vec3(0.0f))), 1.0);
}

TEST(Convolve, KeepsConstantsAndMovesAnImpulse) {
  const Image flat =
      convolve(constant(20, 10, vec3(3.0f)), gaussian_kernel(1.5f, 5), gaussian_kernel(2.0f, 6));
  for (const float value : flat.pixels) EXPECT_NEAR(value, 3.0f, 1e-5f);
  Image impulse(9, 9, 1);
  impulse.at(4, 4)[0] = 1.0f;
  const Kernel shift{1, {1.0f, 0.0f, 0.0f}}, identity{0, {1.0f}};
  const Image moved = convolve(impulse, shift, identity);  // Each pixel takes its left neighbour.
  EXPECT_EQ(moved.at(5, 4)[0], 1.0f);
  EXPECT_EQ(mean(moved), mean(impulse));
}

TEST(Ssim, OfConstantsIsTheLuminanceTerm) {
  Image a(16, 16, 1), b(16, 16, 1);
  for (float& value : a.pixels) value = 0.6f;
  for (float& value : b.pixels) value = 0.4f;
  const float expected = (2.0f * 0.6f * 0.4f + 1e-4f) / (0.36f + 0.16f + 1e-4f);
  EXPECT_NEAR(mean(ssim(a, b)), expected, 1e-3f);
}

TEST(Ssim, OfUnrelatedNoiseIsNearZeroAndOfInvertedNoiseNegative) {
  const Image a = noise(64, 64, 1, 0.0f, 1.0f, 5u), b = noise(64, 64, 1, 0.0f, 1.0f, 6u);
  EXPECT_NEAR(mean(ssim(a, b)), 0.0f, 0.05f);
  Image inverted = a;
  for (float& value : inverted.pixels) value = 1.0f - value;
  EXPECT_LT(mean(ssim(a, inverted)), -0.8f);
}

TEST(Flip, OfBlackAndWhiteFollowsFromThePaper) {
  // HyAB(black, white) = 100, and from green to blue (Hunt-adjusted) it is 203.3; no features
  // differ: 0.95 + 0.05 (100^0.7 - 0.4 c) / (0.6 c) with c = 203.3^0.7 = 41.27.
  const Image map = flip(constant(48, 48, vec3(0.0f)), constant(48, 48, vec3(1.0f)));
  EXPECT_NEAR(mean(map), 0.967f, 0.001f);
}

TEST(Flip, OfIdenticalImagesIsZeroAndOfGreenAndBlueOne) {
  const Image image = noise(40, 40, 3, 0.0f, 1.0f, 7u);
  EXPECT_EQ(mean(flip(image, image)), 0.0f);
  EXPECT_NEAR(mean(flip(constant(40, 40, vec3(0, 1, 0)), constant(40, 40, vec3(0, 0, 1)))), 1.0f,
              1e-4f);
}

TEST(Flip, SeesANewEdgeMoreThanTheSameDifferenceWithoutEdges) {
  Image flat = constant(64, 64, vec3(0.5f)), edge = flat;
  for (int y = 0; y < 64; ++y) {
    for (int x = 32; x < 64; ++x) {
      for (int c = 0; c < 3; ++c) edge.at(x, y)[c] = 0.6f;
    }
  }
  const Image map = flip(edge, flat);
  EXPECT_GT(map.at(33, 32)[0], 1.3f * map.at(60, 32)[0]);
  EXPECT_LT(map.at(4, 32)[0], 1e-3f);
}

TEST(Flip, HidesDetailTooFineForTheEye) {
  // A one-pixel checkerboard of small contrast blurs to its mean at 67 pixels a degree.
  Image fine = constant(64, 64, vec3(0.5f)), coarse = fine;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int c = 0; c < 3; ++c) {
        fine.at(x, y)[c] += (x + y) % 2 == 0 ? 0.1f : -0.1f;
        coarse.at(x, y)[c] += (x / 16 + y / 16) % 2 == 0 ? 0.1f : -0.1f;
      }
    }
  }
  const Image grey = constant(64, 64, vec3(0.5f));
  EXPECT_LT(flip(fine, grey).at(32, 32)[0], 0.3f * mean(flip(coarse, grey)));
}

TEST(HdrFlip, SeesADifferenceInTheShadowsThatTheLdrImageHides) {
  Image b = constant(48, 48, vec3(100.0f));
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 30; ++x) {
      for (int c = 0; c < 3; ++c) b.at(x, y)[c] = 0.01f;
    }
  }
  Image a = b;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 15; ++x) {
      for (int c = 0; c < 3; ++c) a.at(x, y)[c] = 0.02f;
    }
  }
  EXPECT_EQ(mean(hdr_flip(b, b)), 0.0f);
  EXPECT_GT(hdr_flip(a, b).at(4, 24)[0], 0.05f);
  EXPECT_LT(hdr_flip(a, b).at(44, 24)[0], 0.01f);
}

TEST(HeatMap, OfANarrowImageStaysSmall) {
  const Image column = constant(1, 5000, vec3(1.0f));
  const Image map = heat_map(*match_images(column, column, 1.0), false);
  EXPECT_LT(map.width, 100);
  EXPECT_LT(map.height, 5100);
}

TEST(Metrics, TruthAgainstItselfWithItsOwnNoiseIsClean) {
  const std::string base = std::string(LAMBENT_SHARED_DIR) + "/truth/cornell/cornell.DiffInd";
  if (!std::filesystem::exists(base + ".exr")) GTEST_SKIP() << "no truth images at " << base;
  const auto truth = read_image(base + ".exr"), error = read_image(base + "_se.exr");
  ASSERT_TRUE(truth && error);
  MetricsOptions options;
  options.standard_error = error->find("");
  const auto metrics = compare_images(*truth->find(""), *truth->find(""), options);
  ASSERT_TRUE(metrics) << metrics.error().message();
  EXPECT_EQ(metrics->excluded, 0u);
  EXPECT_EQ(*metrics->noise_corrected_relative_rmse, 0.0);
}

}  // namespace
}  // namespace lambent::metrics_test
