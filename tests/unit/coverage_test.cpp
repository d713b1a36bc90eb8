// SPDX-License-Identifier: Apache-2.0
// By which numbers see-through surfaces let samples of pixels through.
#include "scene/coverage.h"

#include <gtest/gtest.h>

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

// A pane that stops a quarter of all rays shows the same at every pixel of four samples.
TEST(Coverage, PanesOfAQuarterHaveNoGrainInFourSamples) {
  Scene scene;
  Material pane;
  pane.unlit = true;
  pane.alpha_mode = AlphaMode::blend;
  pane.base_color = glm::vec4(1.0f, 1.0f, 1.0f, 0.25f);
  pane.double_sided = true;
  scene.materials = {pane};
  scenes::MeshBuilder builder;
  builder.quad({-2.0f, -2.0f, 0.0f}, {2.0f, -2.0f, 0.0f}, {2.0f, 2.0f, 0.0f}, {-2.0f, 2.0f, 0.0f});
  scenes::add_object(scene, builder.take("pane", 0));
  scenes::add_camera(scene, "pane", {0.3f, 0.1f, 1.0f}, {0.3f, 0.1f, 0.0f}, 0.2f, 1.0f);
  const World world(scene);
  FrameSettings settings;
  settings.width = settings.height = 32;
  settings.samples = 4;
  const RenderedFrame frame = Renderer(world).render(scene.cameras.front(), settings).value();
  const Image& seen = *frame.image.find("emission");
  int off = 0;
  for (const float value : seen.pixels) off += std::abs(value - 0.25f) > 1e-6f ? 1 : 0;
  EXPECT_LT(off, static_cast<int>(seen.pixels.size()) / 20);  // where the two triangles meet
}

}  // namespace
}  // namespace lambent::coverage_test
