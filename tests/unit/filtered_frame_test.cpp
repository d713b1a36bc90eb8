// SPDX-License-Identifier: Apache-2.0
// Frames whose noise is filtered, beside the same frames with many more rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include "compose/pixel_math.h"
#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "support/box_behind_a_pane.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"
#include "support/wall_in_a_mirror.h"

namespace lambent::filtered_frame_test {
namespace {

FieldSettings few_probes() {
  FieldSettings settings;
  settings.probe_count = glm::ivec3(5);
  settings.rays_per_probe = 64;
  return settings;
}

FrameSettings of_quality(Quality quality) {
  FrameSettings settings = quality_settings(quality);
  settings.width = settings.height = 96;
  return settings;
}

/// A stage lit by a field, and its pictures.
struct LitStage {
  explicit LitStage(const std::string& name) : LitStage(scenes::make(name).value()) {}
  explicit LitStage(Scene scene)
      : stage(std::move(scene)), field(test::make_field(stage, few_probes(), 4)) {}
  LayeredImage picture(const FrameSettings& settings) const {
    Renderer renderer(stage.world, {.field = &field});
    return renderer.render(stage.scene.cameras.at(0), settings).value().image;
  }
  test::Stage stage;
  IrradianceField field;
};

/// Relative root mean square difference of a layer, over blocks of so many pixels.
double error_of(const LayeredImage& image, const LayeredImage& truth, const char* layer,
                int block) {
  return compare_images(*image.find(layer), *truth.find(layer),
                        {.block = block, .perceptual = false})
      .value()
      .relative_rmse;
}

// Few samples meet the pane more often than it covers; what is filtered has their weights, too.
TEST(FilteredFrame, ShowsBlendedPanesAsMuchAsTheyCover) {
  const LitStage box(test::box_behind_a_pane());
  FrameSettings few = of_quality(Quality::high);
  few.width = few.height = 48;
  FrameSettings many = few;
  many.samples = 64;
  many.gather_rays = 4;
  // Reflections of the few samples vary by 2.5 % from seed to seed, the mean of so many by half
  constexpr std::uint32_t kSeeds = 4;
  for (const bool denoise : {false, true}) {
    few.denoise = many.denoise = denoise;
    const LayeredImage truth = box.picture(many);
    std::map<std::string, double> ratios;
    for (few.seed = 1; few.seed <= kSeeds; ++few.seed) {
      const LayeredImage image = box.picture(few);
      for (const char* layer : {"direct", "indirect", "glossy", "irradiance", "albedo"}) {
        ratios[layer] += compare_images(*image.find(layer), *truth.find(layer),
                                        {.block = 8, .perceptual = false})
                             .value()
                             .mean_ratio /
                         kSeeds;
      }
    }
    for (const auto& [layer, ratio] : ratios) {
      EXPECT_NEAR(ratio, 1.0, 0.02) << layer << (denoise ? ", filtered" : "");
    }
  }
}

TEST(FilteredFrame, ComesCloseToOneOfManyMoreRays) {
  const LitStage cornell("cornell");
  FrameSettings converged = of_quality(Quality::interactive);
  converged.denoise = false;
  FrameSettings noisy = converged;
  converged.gather_rays = 256;
  converged.emissive_samples = 256;
  const LayeredImage truth = cornell.picture(converged);
  const LayeredImage raw = cornell.picture(noisy);
  const LayeredImage filtered = cornell.picture(of_quality(Quality::interactive));
  constexpr double kLess = 0.4;  // of the noise is left at most
  EXPECT_LT(error_of(filtered, truth, "irradiance", 1),
            kLess * error_of(raw, truth, "irradiance", 1));
  // Direct light has noise in soft shadows alone, which are a pixel or two wide in so small a
  // picture: 0.56 of it is left, and at 240x240 0.38
  constexpr double kLessOfDirect = 0.6;
  EXPECT_LT(error_of(filtered, truth, "direct", 1),
            kLessOfDirect * error_of(raw, truth, "direct", 1));
  // On average nothing is lost
  const Metrics mean = compare_images(*filtered.find("irradiance"), *truth.find("irradiance"),
                                      {.block = 8, .perceptual = false})
                           .value();
  EXPECT_NEAR(mean.mean_ratio, 1.0, 0.02);
}

/// A box whose walls, all of this material but for their colours, reflect each other, the lamp and
/// what stands there. The camera sees a small part of it, so that lobes are many pixels wide.
Scene glossy_cornell(Material walls) {
  Scene scene = scenes::make("cornell").value();
  scene.cameras.at(0).vertical_fov *= 0.15f;
  for (Material& material : scene.materials) {
    if (material.emission != glm::vec3(0.0f)) continue;
    walls.base_color = material.base_color;
    material = walls;
  }
  return scene;
}

Scene metal_cornell() {
  Material metal;
  metal.metallic = 1.0f;
  metal.roughness = 0.4f;
  return glossy_cornell(metal);
}

/// Matte walls under a varnish.
Scene varnished_cornell() {
  Material varnished;
  varnished.roughness = 1.0f;
  varnished.clearcoat = 1.0f;
  varnished.clearcoat_roughness = 0.4f;
  return glossy_cornell(varnished);
}

/// Expects that the filter takes noise off the layer "glossy" of one sample, but no light. `most`:
/// share of the noise that may be left.
void expect_less_noise_in_reflections(const LitStage& box,
                                      FrameSettings filtered = of_quality(Quality::high),
                                      double most = 0.7) {
  filtered.samples = 1;  // through the middle of pixels, whatever the seed
  filtered.gather_rays = 0;
  FrameSettings raw = filtered;
  raw.denoise = false;
  FrameSettings filtered_again = filtered, raw_again = raw;
  filtered_again.seed = raw_again.seed = 7;
  const LayeredImage one = box.picture(raw), smooth = box.picture(filtered);
  const auto seen_difference = [](const LayeredImage& a, const LayeredImage& b) {
    return compare_images(*a.find("glossy"), *b.find("glossy"), {}).value().flip;
  };
  EXPECT_LT(seen_difference(smooth, box.picture(filtered_again)),
            most * seen_difference(one, box.picture(raw_again)));
  const Metrics mean =
      compare_images(*smooth.find("glossy"), *one.find("glossy"), {.block = 8, .perceptual = false})
          .value();
  EXPECT_NEAR(mean.mean_ratio, 1.0, 0.005);
}

/// A polished floor under lamps that hang close below sheets of metal: a sample of a lamp, of those
/// that a sheet takes, is bright where it falls into the sheet's lobe.
Scene lamps_close_to_metal() {
  constexpr float kHeight = 2.6f, kGap = 0.005f;
  Scene scene;
  Material floor;
  floor.base_color = glm::vec4(0.35f, 0.35f, 0.35f, 1.0f);
  floor.metallic = 0.0f;
  floor.roughness = 0.3f;
  Material metal = floor;
  metal.base_color = glm::vec4(0.75f, 0.75f, 0.75f, 1.0f);
  metal.metallic = 1.0f;
  metal.roughness = 0.35f;
  scene.materials = {floor, metal, test::lambert(vec3(0.0f), vec3(60.0f))};
  test::add(scene, test::quad({-4, 0, -6}, {0, 0, 12}, {8, 0, 0}, 0));
  for (const float x : {-1.5f, 1.5f}) {
    test::add(scene, test::quad({x - 0.1f, kHeight, -1.0f}, {0.2f, 0, 0}, {0, 0, 2.0f}, 1));
    test::add(scene,
              test::quad({x - 0.015f, kHeight - kGap, -0.9f}, {0.03f, 0, 0}, {0, 0, 1.8f}, 2));
  }
  Camera camera;
  camera.world_from_view =
      glm::inverse(glm::lookAt(vec3(0, 1.5f, 3.5f), vec3(0, 0, 1.0f), vec3(0, 1, 0)));
  scene.cameras = {camera};
  return scene;
}

TEST(FilteredFrame, SpreadsWhatSingleRaysOfCoatsBring) {
  const LitStage floor(lamps_close_to_metal());
  FrameSettings filtered = of_quality(Quality::high);
  filtered.gather_rays = 0;
  FrameSettings raw = filtered, again = filtered;
  raw.denoise = false;
  raw.samples = 64;
  again.seed = 7;
  const LayeredImage smooth = floor.picture(filtered), truth = floor.picture(raw);
  const auto seen_difference = [&](const LayeredImage& from) {
    return compare_images(*smooth.find("glossy"), *from.find("glossy"), {}).value().flip;
  };
  // Were these rays filtered like all others: 0.094 and 0.074
  EXPECT_LT(seen_difference(truth), 0.08);
  EXPECT_LT(seen_difference(floor.picture(again)), 0.06);
}

TEST(FilteredFrame, ShowsRoughCoatsWithLessNoiseAndAllOfTheirLight) {
  expect_less_noise_in_reflections(LitStage(metal_cornell()));
}

/// A room of brushed metal under four small lamps. Rays that corners reflect meet metal close by,
/// and a lamp in it now and then.
Scene metal_room() {
  Scene scene;
  Material metal;
  metal.metallic = 1.0f;
  metal.roughness = 0.3f;
  scene.materials = {metal, test::lambert(vec3(0.0f), vec3(20.0f))};
  test::add_room(scene, 2.0f, 0);
  for (const float x : {-0.5f, 0.5f}) {
    for (const float z : {-0.5f, 0.5f}) {
      test::add(scene, test::quad({x - 0.1f, 0.99f, z - 0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, 1));
    }
  }
  Camera camera;
  camera.world_from_view =
      glm::inverse(glm::lookAt(vec3(0, -0.2f, 0.9f), vec3(0.1f, -0.2f, 0), vec3(0, 1, 0)));
  scene.cameras = {camera};
  return scene;
}

TEST(FilteredFrame, ShowsMetalInMetalWithLessNoiseAndAllOfItsLight) {
  expect_less_noise_in_reflections(LitStage(metal_room()));
}

TEST(FilteredFrame, ShowsRoughClearcoatsWithLessNoiseAndAllOfTheirLight) {
  expect_less_noise_in_reflections(LitStage(varnished_cornell()));
}

TEST(FilteredFrame, ShowsRoughCoatsInMirrorsWithLessNoiseAndAllOfTheirLight) {
  // Rays of neighbours are reused in the second one
  for (const float roughness : {0.0f, 0.09f}) {
    expect_less_noise_in_reflections(LitStage(test::wall_in_a_mirror(roughness, 1.0f)));
  }
}

// Rays from the foot of a wall meet the floor close by, each in another place.
TEST(FilteredFrame, ShowsCornersInMirrorsWithLessNoiseAndAllOfTheirLight) {
  Scene scene = test::wall_in_a_mirror(0.0f, 1.0f);
  scene.cameras = {look_at({0.0f, 1.4f, 0.5f}, {-0.3f, 0.12f, -6.0f}, 0.1f)};
  // 0.55 where lobes are compared by what is near alone
  expect_less_noise_in_reflections(LitStage(std::move(scene)), of_quality(Quality::high), 0.46);
}

TEST(FilteredFrame, ShowsWhatLampsLightInMirrorsWithLessNoiseAndAllOfTheirLight) {
  Scene scene = test::wall_in_a_mirror(0.0f, 0.0f);
  scene.materials[1].lambert = true;
  FrameSettings noisy = of_quality(Quality::high);
  noisy.reflected_emissive_samples = 1;
  expect_less_noise_in_reflections(LitStage(std::move(scene)), noisy);
}

// Small metal balls, whose lobes point away from each other from pixel to pixel.
TEST(FilteredFrame, FurtherRaysTakeNoiseOffCurvedMetalAndNoLight) {
  const LitStage balls("spheres");
  const auto noise_and_mean = [&](int coat_rays) {
    FrameSettings one = of_quality(Quality::high);
    one.width = one.height = 64;
    one.samples = 1;
    one.gather_rays = 0;
    one.coat_rays = coat_rays;
    FrameSettings again = one;
    again.seed = 7;
    const LayeredImage a = balls.picture(one), b = balls.picture(again);
    const Metrics found =
        compare_images(*a.find("glossy"), *b.find("glossy"), {.perceptual = false}).value();
    return glm::dvec2(found.relative_rmse, found.mean_a);
  };
  const glm::dvec2 first = noise_and_mean(1), further = noise_and_mean(8);
  EXPECT_LT(further.x, 0.75 * first.x);
  EXPECT_NEAR(further.y, first.y, 0.02 * first.y);
}

// Just above a lamp's horizon rounding alone decides how little light arrives there. One pixel
// whose light is no number would spread over all that the filter reaches.
TEST(FilteredFrame, LightOfLampsIsANumberHoweverLittleArrives) {
  Reflectance matte;
  matte.diffuse = vec3(0.5f);
  constexpr int kFewestDecades = -45;  // float has no smaller numbers
  for (int decade = kFewestDecades; decade <= 0; ++decade) {
    const float unoccluded = std::pow(10.0f, static_cast<float>(decade));
    for (const float found : {0.0f, unoccluded}) {
      const FilteredEmitter emitter =
          filtered_emitter(matte, matte.diffuse * found, vec3(unoccluded));
      EXPECT_TRUE(std::isfinite(emitter.light.x)) << unoccluded << " " << found;
      EXPECT_TRUE(std::isfinite(filtered_variance(emitter, found * found))) << unoccluded;
    }
  }
}

// Car paint: rays of a smooth clearcoat find lamps, so that highlights of what it lies on are
// filtered as though that lay bare, whichever way the coat's normal points.
TEST(FilteredFrame, HighlightsUnderASmoothClearcoatAreThoseOfTheBase) {
  Reflectance paint;
  paint.alpha = 0.16f;
  EXPECT_FLOAT_EQ(highlight_alpha(paint), 0.16f) << "bare";
  paint.layers.clearcoat = 1.0f;
  paint.layers.clearcoat_normal = vec3(0.0f, 0.0f, 1.0f);
  paint.layers.clearcoat_alpha = 0.0001f;
  EXPECT_FLOAT_EQ(highlight_alpha(paint), 0.16f) << "smooth";
  paint.layers.clearcoat_normal = vec3(0.6f, 0.0f, 0.8f);
  EXPECT_FLOAT_EQ(highlight_alpha(paint), 0.16f) << "smooth, with a normal of its own";
  paint.layers.clearcoat_alpha = 0.01f;
  EXPECT_FLOAT_EQ(highlight_alpha(paint), 0.0f) << "rough, with a normal of its own";
  paint.layers.clearcoat_normal = vec3(0.0f, 0.0f, 1.0f);
  EXPECT_FLOAT_EQ(highlight_alpha(paint), 0.01f) << "rough: the narrower lobe";
}

// Settings may change from frame to frame: nothing of the frame before is shown.
TEST(FilteredFrame, OfARendererThatFilteredBeforeIsThatOfANewOne) {
  const LitStage metal(metal_cornell());
  FrameSettings filtered = of_quality(Quality::interactive);
  FrameSettings unreflected = filtered, raw = filtered;
  unreflected.glossy_rows = 0;
  raw.denoise = false;
  Renderer renderer(metal.stage.world, {.field = &metal.field});
  for (const FrameSettings& settings : {filtered, unreflected, filtered, raw, filtered}) {
    const Camera& camera = metal.stage.scene.cameras.at(0);
    const LayeredImage shown = renderer.render(camera, settings).value().image;
    const LayeredImage anew = metal.picture(settings);
    for (const Layer& layer : anew.layers) {
      EXPECT_TRUE(shown.find(layer.name)->pixels == layer.image.pixels)
          << layer.name << " filtered " << settings.denoise << " rows " << settings.glossy_rows;
    }
  }
}

TEST(FilteredFrame, LeavesHardShadowsOfASpotLightAsTheyAre) {
  const LitStage spot("cornell-spot");
  FrameSettings filtered = of_quality(Quality::interactive), raw = filtered;
  raw.denoise = false;
  const LayeredImage a = spot.picture(filtered), b = spot.picture(raw);
  EXPECT_EQ(a.find("direct")->pixels, b.find("direct")->pixels);
  EXPECT_NE(a.find("irradiance")->pixels, b.find("irradiance")->pixels);
}

TEST(FilteredFrame, IsTheSumOfItsLayers) {
  const LayeredImage image = LitStage("cornell").picture(of_quality(Quality::high));
  const std::vector<float>& all = image.find("")->pixels;
  for (std::size_t i = 0; i < all.size(); ++i) {
    float sum = 0.0f;
    for (const char* part : {"direct", "indirect", "glossy", "emission"}) {
      sum += image.find(part)->pixels[i];
    }
    EXPECT_NEAR(all[i], sum, 1e-4f * (1.0f + sum));
  }
}

TEST(FilteredFrame, QualitiesDifferInWhatTheyCost) {
  const FrameSettings draft = quality_settings(Quality::draft);
  EXPECT_EQ(draft.gather_rays, 0);
  EXPECT_FALSE(draft.denoise);
  const FrameSettings interactive = quality_settings(Quality::interactive);
  EXPECT_EQ(interactive.samples * interactive.gather_rays, 1);
  EXPECT_TRUE(interactive.denoise);
  const FrameSettings high = quality_settings(Quality::high);
  EXPECT_EQ(high.samples * high.gather_rays, 64);
  EXPECT_TRUE(high.denoise);
}

TEST(FilteredFrame, WithoutAFieldFiltersDirectLightAlone) {
  const test::Stage stage("cornell");
  FrameSettings filtered = of_quality(Quality::interactive), raw = filtered;
  raw.denoise = false;
  Renderer renderer(stage.world);
  const Camera& camera = stage.scene.cameras.at(0);
  const RenderedFrame a = renderer.render(camera, filtered).value();
  const RenderedFrame b = renderer.render(camera, raw).value();
  EXPECT_NE(a.image.find("direct")->pixels, b.image.find("direct")->pixels);
  for (const float e : a.image.find("irradiance")->pixels) EXPECT_EQ(e, 0.0f);
}

}  // namespace
}  // namespace lambent::filtered_frame_test
