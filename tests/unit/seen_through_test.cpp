// SPDX-License-Identifier: Apache-2.0
// What glass shows, once its noise is filtered.
#include <gtest/gtest.h>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "support/field_scenes.h"
#include "support/floor_behind_a_pane.h"
#include "support/hand_made.h"

namespace lambent::seen_through_test {
namespace {

constexpr float kClear = 0.0f, kFrosted = 0.4f;  // roughness

/// A floor behind a pane, lit by a field, and what the pane shows.
struct Pane {
  Pane(const Material& floor, float roughness, bool slab = false)
      : Pane(test::floor_behind_a_pane(floor, roughness, slab)) {}
  explicit Pane(Scene scene)
      : stage(std::move(scene)), field(test::make_field(stage, few_probes(), 2)) {}
  static FieldSettings few_probes() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(4);
    settings.rays_per_probe = 64;
    return settings;
  }
  /// Through the middle of pixels, whatever the seed.
  static FrameSettings settings(bool filtered) {
    FrameSettings settings = quality_settings(Quality::interactive);
    settings.width = settings.height = 96;
    settings.denoise = filtered;
    settings.reflected_emissive_samples = 2;
    settings.samples = 1;
    settings.temporal_antialiasing = false;
    settings.averaged_frames = 1;
    return settings;
  }
  LayeredImage picture(const FrameSettings& settings) const {
    Renderer renderer(stage.world, {.field = &field});
    return renderer.render(stage.scene.cameras.at(0), settings).value().image;
  }
  test::Stage stage;
  IrradianceField field;
};

Metrics difference(const LayeredImage& image, const LayeredImage& other, int block = 1) {
  return compare_images(*image.find("transmission"), *other.find("transmission"),
                        {.block = block, .perceptual = false})
      .value();
}

/// The mean of pictures of many seeds.
LayeredImage mean_picture(const Pane& pane, FrameSettings settings, int pictures) {
  LayeredImage mean = pane.picture(settings);
  Image& sum = mean.require("transmission", 3);
  for (int i = 1; i < pictures; ++i) {
    settings.seed = static_cast<std::uint32_t>(100 + i);
    const LayeredImage next = pane.picture(settings);
    for (std::size_t k = 0; k < sum.pixels.size(); ++k) {
      sum.pixels[k] += next.find("transmission")->pixels[k];
    }
  }
  for (float& value : sum.pixels) value /= static_cast<float>(pictures);
  return mean;
}

/// Expects less than a share of the noise, and all of the light.
void expect_less_noise(const Pane& pane, double share) {
  const LayeredImage truth = mean_picture(pane, Pane::settings(false), 64);
  const LayeredImage raw = pane.picture(Pane::settings(false));
  const LayeredImage filtered = pane.picture(Pane::settings(true));
  EXPECT_LT(difference(filtered, truth).relative_rmse,
            share * difference(raw, truth).relative_rmse);
  const LayeredImage mean = mean_picture(pane, Pane::settings(true), 16);
  EXPECT_NEAR(difference(mean, truth).mean_ratio, 1.0, 0.01);
}

TEST(SeenThrough, ClearGlassShowsMatteFloorsWithLessNoise) {
  expect_less_noise(Pane(test::matte_floor(), kClear), 0.5);
}

TEST(SeenThrough, ClearGlassShowsCoatsWithLessNoise) {
  expect_less_noise(Pane(test::metal_floor(), kClear), 0.6);
}

// What the lacquer shows of the ceiling is not taken for the first surface behind the glass.
TEST(SeenThrough, ClearGlassShowsLacquerUnderACeilingWithAllOfItsLight) {
  Scene scene = test::floor_behind_a_pane(test::lacquered_floor(), kClear);
  test::add(scene, test::quad({-9, 2.5f, -9}, {18, 0, 0}, {0, 0, 18}, 0));
  const Pane pane(std::move(scene));
  FrameSettings settings = Pane::settings(false);
  settings.width = settings.height = 32;
  const LayeredImage truth = mean_picture(pane, settings, 64);
  settings.denoise = true;
  EXPECT_NEAR(difference(mean_picture(pane, settings, 32), truth).mean_ratio, 1.0, 0.02);
}

TEST(SeenThrough, FrostedGlassShowsLessNoise) {
  expect_less_noise(Pane(test::matte_floor(), kFrosted), 0.4);
}

TEST(SeenThrough, FrostedSlabsShowLessNoise) {
  expect_less_noise(Pane(test::matte_floor(), kFrosted, true), 0.7);
}

/// A floor that glows alike all over, and reflects nothing.
Material glowing_floor() {
  Material floor = test::matte_floor();
  floor.emission = glm::vec3(1.0f);
  floor.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  return floor;
}

/// The share of values that differ by more than `limit`.
double share_that_differs(const Image& seen, const Image& truth, float limit) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    differ += std::abs(seen.pixels[i] - truth.pixels[i]) > limit ? 1 : 0;
  }
  return static_cast<double>(differ) / static_cast<double>(seen.pixels.size());
}

// Light is reflected within a clear slab, too. Where chance decided between that and what lies
// behind, one pixel in twenty-five would be black.
TEST(SeenThrough, ClearSlabsHaveNoGrainOfReflectionsWithin) {
  const Pane pane(glowing_floor(), kClear, true);
  const Image seen = *pane.picture(Pane::settings(false)).find("transmission");
  const Image truth = *mean_picture(pane, Pane::settings(false), 32).find("transmission");
  EXPECT_EQ(share_that_differs(seen, truth, 0.05f), 0.0);
}

/// Four slabs of clear glass behind each other, before a floor that glows.
Scene many_slabs() {
  Scene scene = test::floor_behind_a_pane(glowing_floor(), kClear, true);
  const std::size_t first = scene.instances.size() - 3;  // pane, back, lamp
  for (int slab = 1; slab < 4; ++slab) {
    for (std::size_t side = first; side < first + 2; ++side) {
      Instance copy = scene.instances[side];
      copy.world_from_object[3].z -= 0.3f * static_cast<float>(slab);
      scene.instances.push_back(copy);
    }
  }
  return scene;
}

/// The layer `transmission` of few pixels.
Image transmission_of(const Scene& scene, int samples, std::uint32_t seed) {
  const World world(scene);
  Renderer renderer(world);
  FrameSettings settings = Pane::settings(false);
  settings.width = settings.height = 32;
  settings.samples = samples;
  settings.seed = seed;
  return *renderer.render(scene.cameras.at(0), settings).value().image.find("transmission");
}

// A wine glass before a bottle: eight surfaces.
TEST(SeenThrough, ManyClearSlabsHaveLittleGrain) {
  const Scene scene = many_slabs();
  EXPECT_LT(share_that_differs(transmission_of(scene, 4, 1), transmission_of(scene, 256, 9), 0.1f),
            0.1);
}

// The way that crosses all surfaces is followed at each pixel, and the other light is there, too.
TEST(SeenThrough, ManyClearSlabsAreNeverBlackInOneSample) {
  const Scene scene = many_slabs();
  const Image truth = transmission_of(scene, 256, 9);
  double sum = 0.0, expected = 0.0;
  int dark = 0, lit = 0;
  for (std::uint32_t seed = 1; seed <= 16; ++seed) {
    const Image seen = transmission_of(scene, 1, seed);
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
      if (truth.pixels[i] > 0.5f) ++lit;
      dark += truth.pixels[i] > 0.5f && seen.pixels[i] < 0.5f * truth.pixels[i] ? 1 : 0;
      sum += seen.pixels[i];
      expected += truth.pixels[i];
    }
  }
  EXPECT_GT(lit, 0);
  EXPECT_EQ(dark, 0);
  EXPECT_NEAR(sum / expected, 1.0, 0.01);
}

TEST(SeenThrough, IsThereWithoutAFieldAndWithFog) {
  Scene scene = test::floor_behind_a_pane(test::metal_floor(), kFrosted);
  scene.fog.resize(1);
  const World world(scene);
  FrameSettings settings = Pane::settings(true);
  settings.samples = 2;
  Renderer renderer(world);
  const Image filtered =
      *renderer.render(scene.cameras.at(0), settings).value().image.find("transmission");
  settings.denoise = false;
  const Image raw =
      *renderer.render(scene.cameras.at(0), settings).value().image.find("transmission");
  const double ratio =
      compare_images(filtered, raw, {.block = 8, .perceptual = false}).value().mean_ratio;
  EXPECT_NEAR(ratio, 1.0, 0.1);
}

TEST(SeenThrough, PicturesAreTheSumOfTheirLayers) {
  const LayeredImage image = Pane(test::metal_floor(), kFrosted).picture(Pane::settings(true));
  const std::vector<float>& all = image.find("")->pixels;
  for (std::size_t i = 0; i < all.size(); ++i) {
    float sum = 0.0f;
    for (const char* part : {"direct", "indirect", "glossy", "transmission", "emission"}) {
      sum += image.find(part)->pixels[i];
    }
    EXPECT_NEAR(all[i], sum, 1e-4f * (1.0f + sum));
  }
}

TEST(SeenThrough, APartOfAPictureIsThatOfTheWhole) {
  const Pane pane(test::metal_floor(), kFrosted);
  FrameSettings part = Pane::settings(true);
  part.width = 24;
  part.height = 200;
  const LayeredImage whole = pane.picture(part);
  part.first_row = 90;
  part.rows = 7;
  const LayeredImage rows = pane.picture(part);
  const std::vector<float>& expected = whole.find("transmission")->pixels;
  const std::vector<float>& found = rows.find("transmission")->pixels;
  const std::size_t first = static_cast<std::size_t>(3 * part.first_row * part.width);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], expected[first + i]) << i;
}

}  // namespace
}  // namespace lambent::seen_through_test
