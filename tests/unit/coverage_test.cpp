// SPDX-License-Identifier: Apache-2.0
// By which numbers see-through surfaces let samples of pixels through.
#include "scene/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

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
        const float drawn = uniform_of_sample(sample_mask(pixel, i, kSeed), 2, 7);
        ASSERT_GE(drawn, 0.0f);
        ASSERT_LT(drawn, 1.0f);
        parts.insert(static_cast<int>(drawn * static_cast<float>(samples)));
      }
      EXPECT_EQ(parts.size(), samples) << "pixel " << pixel;
    }
  }
}

// Two panes, one behind the other, stop what each of them would stop alone: neither hangs on what
// the other one does.
TEST(Coverage, PanesBehindOneAnotherDecideEachForItself) {
  constexpr std::uint32_t kPixels = 40000;
  for (const std::uint32_t sample : {0u, 1u, 2u, 300u}) {
    int both = 0, first = 0, before = 0;
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
      const std::uint32_t mask = sample_mask(pixel, sample, kSeed);
      const bool here = uniform_of_sample(mask, 0, 7) < 0.3f;
      first += here ? 1 : 0;
      both += here && uniform_of_sample(mask, 1, 7) < 0.5f ? 1 : 0;
      before += here && uniform_of_sample(sample_mask(pixel, sample ^ 1u, kSeed), 1, 8) < 0.5f;
    }
    EXPECT_NEAR(first, 0.3 * kPixels, 0.01 * kPixels);
    EXPECT_NEAR(both, 0.15 * kPixels, 0.01 * kPixels);
    EXPECT_NEAR(before, 0.15 * kPixels, 0.01 * kPixels);
  }
}

TEST(Coverage, OnlyRaysOfSamplesCarryOne) {
  EXPECT_TRUE(carries_sample(sample_mask(0, 0, 0)));
  EXPECT_TRUE(carries_sample(sample_mask(0xFFFFFFFFu, 0xFFFFFFFFu, 1)));
  for (const std::uint32_t mask : {kRayMeetsAll, kRayGathers, kRayOfProbe, kRayOfMotion, 0u}) {
    EXPECT_FALSE(carries_sample(mask));
  }
}

/// A picture, four samples a pixel, of what a square of 0.2 m emits, which stops a quarter of
/// all rays, is made of `cells` x `cells` quads and turned by `turn` [rad] about +Y.
Image quarter_pane(int cells, float turn) {
  constexpr float kSide = 0.2f;
  Scene scene;
  Material pane;
  pane.unlit = true;
  pane.alpha_mode = AlphaMode::blend;
  pane.base_color = glm::vec4(1.0f, 1.0f, 1.0f, 0.25f);
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

/// Share of values that are not a quarter.
float grain_of(const Image& seen) {
  const auto off = std::count_if(seen.pixels.begin(), seen.pixels.end(),
                                 [](float value) { return std::abs(value - 0.25f) > 1e-6f; });
  return static_cast<float>(off) / static_cast<float>(seen.pixels.size());
}

// A pane that stops a quarter of all rays shows the same at every pixel of four samples, also where
// its triangles are smaller than pixels. Where two layers meet, which of a pane seen
// aslant is in every sixth pixel or so, some differ.
TEST(Coverage, PanesOfAQuarterHaveNoGrainInFourSamples) {
  EXPECT_LT(grain_of(quarter_pane(1, 0.0f)), 0.05f);
  EXPECT_LT(grain_of(quarter_pane(400, 0.0f)), 0.05f);
  EXPECT_LT(grain_of(quarter_pane(400, 0.8f)), 0.2f);
}

// Folds of one mesh, a hundredth of their distance apart, decide each for itself.
TEST(Coverage, FoldsOfAMeshDecideEachForItself) {
  constexpr std::uint32_t kPixels = 40000;
  int both = 0;
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    const std::uint32_t mask = sample_mask(pixel, 1, kSeed);
    both += uniform_of_sample(mask, 0, coverage_layer(3.0f)) < 0.3f &&
                    uniform_of_sample(mask, 0, coverage_layer(3.03f)) < 0.5f
                ? 1
                : 0;
  }
  EXPECT_NEAR(both, 0.15 * kPixels, 0.01 * kPixels);
}

}  // namespace
}  // namespace lambent::coverage_test
