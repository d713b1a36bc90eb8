// SPDX-License-Identifier: Apache-2.0
// By which numbers see-through surfaces let samples of pixels through.
#include "scene/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "lambent/renderer.h"
#include "lambent/world.h"
#include "raytracing/ray_records.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"

namespace lambent::coverage_test {
namespace {

constexpr std::uint32_t kSeed = 3;

TEST(Coverage, SamplesOfAPixelLieInEqualParts) {
  for (std::uint32_t pixel = 0; pixel < 100; ++pixel) {
    for (const std::uint32_t samples : {2u, 4u, 8u, 64u, 256u}) {
      std::set<int> parts;
      for (std::uint32_t i = 0; i < samples; ++i) {
        const float drawn = uniform_of_sample(sample_mask(pixel, i, samples, kSeed));
        ASSERT_GE(drawn, 0.0f);
        ASSERT_LT(drawn, 1.0f);
        parts.insert(static_cast<int>(drawn * static_cast<float>(samples)));
      }
      EXPECT_EQ(parts.size(), samples) << "pixel " << pixel;
    }
  }
}

// Frames of one sample, or of a few that are no power of 2, go on where the last one ended.
TEST(Coverage, SamplesOfSuccessiveFramesLieInEqualParts) {
  for (const std::uint32_t in_a_frame : {1u, 2u, 3u, 4u, 6u}) {
    for (std::uint32_t pixel = 0; pixel < 100; ++pixel) {
      std::set<int> parts;
      for (std::uint32_t i = 0; i < 16; ++i) {
        parts.insert(
            static_cast<int>(16.0f * uniform_of_sample(sample_mask(pixel, i, in_a_frame, kSeed))));
      }
      EXPECT_EQ(parts.size(), 16u) << in_a_frame << ", pixel " << pixel;
    }
  }
}

TEST(Coverage, SamplesShowAPaneInAllPixelsOrInNone) {
  constexpr std::uint32_t kSamples = 16;
  // Under temporal anti-aliasing, numbers go on from frame to frame
  for (std::uint32_t i = 0; i < 3 * kSamples; ++i) {
    std::set<int> parts;
    std::set<float> numbers;
    for (std::uint32_t pixel = 0; pixel < 100; ++pixel) {
      const float drawn = uniform_of_sample(sample_mask(pixel, i, kSamples, kSeed));
      parts.insert(static_cast<int>(drawn * static_cast<float>(kSamples)));
      numbers.insert(drawn);
    }
    EXPECT_EQ(parts.size(), 1u) << i;
    // What covers too little for a whole sample is left to chance in each pixel
    EXPECT_GT(numbers.size(), 90u) << i;
  }
}

/// The surface at which a pixel's sample ends, of those that cover `alphas` of what is before them,
/// front to back; their number if it ends at none.
std::size_t end_of_sample(OrderedCoverage& met, std::span<const float> alphas) {
  std::size_t surface = 0;
  while (surface < alphas.size() &&
         !ends_sample(met, alphas[surface], static_cast<float>(surface + 1))) {
    ++surface;
  }
  return surface;
}

/// Of `samples` samples of a pixel, how many end at each of the surfaces; the last one counts those
/// that end at none.
std::vector<int> ends_of_samples(std::uint32_t pixel, std::uint32_t samples,
                                 std::span<const float> alphas) {
  std::vector<int> ends(alphas.size() + 1, 0);
  for (std::uint32_t i = 0; i < samples; ++i) {
    OrderedCoverage met = start_coverage(sample_mask(pixel, i, samples, kSeed));
    ++ends[end_of_sample(met, alphas)];
  }
  return ends;
}

/// The weights of those samples, over their number.
std::vector<float> weights_of_samples(std::uint32_t pixel, std::uint32_t samples,
                                      std::span<const float> alphas) {
  std::vector<float> weights(alphas.size() + 1, 0.0f);
  for (std::uint32_t i = 0; i < samples; ++i) {
    OrderedCoverage met = start_coverage(sample_mask(pixel, i, samples, kSeed));
    const std::size_t end = end_of_sample(met, alphas);
    weights[end] += weight_of_sample(met) / static_cast<float>(samples);
  }
  return weights;
}

// Panes in a row get the share of the samples that they have in the pixel, to the sample.
TEST(Coverage, PanesBehindOneAnotherGetTheirSharesOfTheSamples) {
  for (std::uint32_t pixel = 0; pixel < 100; ++pixel) {
    EXPECT_EQ(ends_of_samples(pixel, 16, std::vector{0.5f, 0.25f, 0.5f}),
              (std::vector{8, 2, 3, 3}));
  }
}

TEST(Coverage, PixelsShowAPaneAsMuchAsItCovers) {
  for (const float alpha : {0.02f, 0.15f, 0.3f, 0.5f, 0.77f, 0.98f}) {
    for (const std::uint32_t samples : {4u, 8u, 16u, 64u}) {
      for (std::uint32_t pixel = 0; pixel < 50; ++pixel) {
        const auto weights = weights_of_samples(pixel, samples, std::vector{alpha});
        EXPECT_NEAR(weights[0], alpha, 1e-5f) << samples << " samples, pixel " << pixel;
        EXPECT_NEAR(weights[1], 1.0f - alpha, 1e-5f) << samples << " samples, pixel " << pixel;
      }
    }
  }
}

// The mean over pixels of what they show of several panes is exact, however many samples they have.
TEST(Coverage, PixelsShowPanesInTheMeanAsMuchAsTheyCover) {
  constexpr std::uint32_t kPixels = 20000;
  for (const float alpha : {0.005f, 0.15f, 0.77f, 0.99f}) {
    const std::vector panes{alpha, 0.3f, alpha, 0.15f};
    for (const std::uint32_t samples : {1u, 2u, 4u, 6u, 16u}) {
      // Four standard deviations of a decision by one sample in each pixel
      const double tolerance = 2.0 / std::sqrt(static_cast<double>(kPixels));
      std::vector<double> means(panes.size() + 1, 0.0);
      for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        const auto weights = weights_of_samples(pixel, samples, panes);
        for (std::size_t i = 0; i < means.size(); ++i) means[i] += weights[i] / kPixels;
      }
      double open = 1.0;
      for (std::size_t i = 0; i < panes.size(); ++i) {
        EXPECT_NEAR(means[i], open * panes[i], tolerance) << samples << " samples, pane " << i;
        open *= 1.0 - panes[i];
      }
      EXPECT_NEAR(means.back(), open, tolerance) << samples << " samples";
    }
  }
}

// Smoke of many faint layers leaves most samples to what is behind it.
TEST(Coverage, ThinLayersLeaveSamplesToWhatIsBehindThem) {
  for (const float alpha : {0.004f, 0.03f}) {
    const std::vector layers(12, alpha);
    double samples = 0.0;
    for (std::uint32_t pixel = 0; pixel < 100; ++pixel) {
      samples += ends_of_samples(pixel, 16, layers).back() / 100.0;
    }
    // Nine of the thicker layers take a sample each; of the other seven, three layers leave 6.39 in
    // the mean over pixels
    EXPECT_GT(samples, 6.3) << alpha;
  }
}

// Behind more surfaces than are met in order, rays go on by chance: they carry no sample any more.
TEST(Coverage, ChanceDecidesBehindManySurfaces) {
  OrderedCoverage met = start_coverage(sample_mask(5, 0, 4, kSeed));
  for (std::uint32_t i = 0; i < kMaxOrderedSurfaces; ++i) {
    EXPECT_TRUE(carries_sample(met.ray_mask));
    ASSERT_FALSE(ends_sample(met, 0.0f, 1.0f));
  }
  EXPECT_EQ(met.ray_mask, kRayMeetsAll);
  EXPECT_TRUE(ends_sample(met, 0.0f, 1.0f)) << "where such a ray stops the sample ends";
}

TEST(Coverage, OnlyRaysOfSamplesCarryOne) {
  EXPECT_TRUE(carries_sample(sample_mask(0, 0, 1, 0)));
  EXPECT_TRUE(carries_sample(sample_mask(0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 1)));
  for (const std::uint32_t mask : {kRayMeetsAll, kRayGathers, kRayOfProbe, kRayOfMotion, 0u}) {
    EXPECT_FALSE(carries_sample(mask));
  }
}

/// A picture, four samples a pixel, of what a square of 0.2 m emits, which covers `alpha` of what
/// is behind it, is made of `cells` x `cells` quads and turned by `turn` [rad] about +Y.
Image pane(int cells, float turn, float alpha) {
  constexpr float kSide = 0.2f;
  Scene scene;
  Material pane;
  pane.unlit = true;
  pane.alpha_mode = AlphaMode::blend;
  pane.base_color = glm::vec4(1.0f, 1.0f, 1.0f, alpha);
  pane.double_sided = true;
  scene.materials = {pane};
  scenes::MeshBuilder builder;
  const glm::vec3 across = glm::vec3(std::cos(turn), 0.0f, std::sin(turn)) * (kSide / cells);
  const glm::vec3 up(0.0f, kSide / cells, 0.0f);
  const glm::vec3 corner = -0.5f * static_cast<float>(cells) * (across + up);
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const glm::vec3 at = corner + static_cast<float>(x) * across + static_cast<float>(y) * up;
      builder.quad(at, at + across, at + across + up, at + up);
    }
  }
  scenes::add_object(scene, builder.take("pane", 0));
  scenes::add_camera(scene, "pane", {0.03f, 0.01f, 1.0f}, {0.03f, 0.01f, 0.0f}, 0.03f, 1.0f);
  const World world(scene);
  FrameSettings settings;
  settings.width = settings.height = 32;
  settings.samples = 4;
  const RenderedFrame frame = Renderer(world).render(scene.cameras.front(), settings).value();
  return *frame.image.find("emission");
}

/// Share of values that are not `alpha`.
float grain_of(const Image& seen, float alpha) {
  const auto off = std::count_if(seen.pixels.begin(), seen.pixels.end(),
                                 [&](float value) { return std::abs(value - alpha) > 1e-6f; });
  return static_cast<float>(off) / static_cast<float>(seen.pixels.size());
}

// A pane shows the same at every pixel of four samples, also where its triangles are smaller than
// pixels, and where it is seen aslant.
TEST(Coverage, PanesHaveNoGrainInFourSamples) {
  for (const float alpha : {0.1f, 0.25f, 0.6f}) {
    EXPECT_EQ(grain_of(pane(1, 0.0f, alpha), alpha), 0.0f);
    EXPECT_EQ(grain_of(pane(400, 0.0f, alpha), alpha), 0.0f);
    EXPECT_EQ(grain_of(pane(1, 1.0f, alpha), alpha), 0.0f);
    EXPECT_EQ(grain_of(pane(400, 1.0f, alpha), alpha), 0.0f);
  }
}

/// A square of 2 m at z, which emits `emission` and covers `alpha` of what is behind it.
void add_pane(Scene& scene, float z, float alpha, const glm::vec3& color) {
  Material pane;
  pane.unlit = true;
  pane.alpha_mode = alpha < 1.0f ? AlphaMode::blend : AlphaMode::opaque;
  pane.base_color = glm::vec4(color, alpha);
  scene.materials.push_back(pane);
  scenes::MeshBuilder builder;
  builder.quad({-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z});
  scenes::add_object(scene, builder.take("pane", static_cast<int>(scene.materials.size()) - 1));
}

// A decal lies a hair before the wall that it is on, or in its very plane, where either may be in
// front: what passes it meets the wall. Twenty panes, more than are met in order, cover what each
// of them covers.
TEST(Coverage, WhatPassesMeetsWhatIsInTheSamePlaneAndFarBehind) {
  const auto mean_of = [](const Scene& scene, std::size_t channel) {
    const World world(scene);
    FrameSettings settings;
    settings.width = settings.height = 32;
    settings.samples = 16;
    Camera camera = scene.cameras.front();
    const Image seen = *Renderer(world).render(camera, settings).value().image.find("emission");
    double sum = 0.0;
    for (std::size_t i = channel; i < seen.pixels.size(); i += 3) sum += seen.pixels[i];
    return sum / (static_cast<double>(seen.pixels.size()) / 3.0);
  };
  for (const float before : {0.0f, 1e-6f}) {
    Scene decal;
    add_pane(decal, 0.0f, 1.0f, {0, 1, 0});
    add_pane(decal, before, 0.25f, {1, 0, 0});
    scenes::add_camera(decal, "decal", {0.03f, 0.01f, 1.0f}, {0.03f, 0.01f, 0.0f}, 0.9f, 1.0f);
    EXPECT_NEAR(mean_of(decal, 0) + mean_of(decal, 1), 1.0, 1e-6);
    if (before > 0.0f) {
      EXPECT_NEAR(mean_of(decal, 0), 0.25, 1e-6);
    }
  }

  constexpr int kPanes = 20;
  Scene panes;
  for (int i = 0; i < kPanes; ++i) add_pane(panes, -0.1f * static_cast<float>(i), 0.05f, {1, 0, 0});
  add_pane(panes, -0.1f * kPanes, 1.0f, {0, 1, 0});
  scenes::add_camera(panes, "panes", {0.03f, 0.01f, 1.0f}, {0.03f, 0.01f, 0.0f}, 0.3f, 1.0f);
  const double open = std::pow(0.95, kPanes);
  EXPECT_NEAR(mean_of(panes, 0), 1.0 - open, 0.01);
  EXPECT_NEAR(mean_of(panes, 1), open, 0.01);
}

}  // namespace
}  // namespace lambent::coverage_test
