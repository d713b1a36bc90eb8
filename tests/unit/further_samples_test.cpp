// SPDX-License-Identifier: Apache-2.0
// Further samples of the pixels whose samples differ visibly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compose/adaptive/pixel_noise.h"
#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "support/box_behind_a_pane.h"
#include "support/field_scenes.h"

namespace lambent::further_samples_test {
namespace {

/// The pixels of a row of five that take further samples: 0 stands for those.
std::vector<std::uint8_t> chosen(const std::vector<std::vector<float>>& samples,
                                 std::vector<std::uint8_t> skipped = std::vector<std::uint8_t>(5)) {
  PixelNoise noise(5, 1);
  std::vector<float> sum(5, 0.0f);
  const float share = 1.0f / static_cast<float>(samples.size());
  for (const std::vector<float>& sample : samples) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * sample[i];
    noise.add(sum, share, {});
  }
  noise.expose(0.0f);
  noise.choose(skipped);
  return skipped;
}

using Flags = std::vector<std::uint8_t>;

TEST(PixelNoise, ChoosesPixelsWhoseSamplesDiffer) {
  const std::vector<std::vector<float>> edge = {{1, 1, 1, 2, 2}, {1, 1, 2, 2, 2}, {1, 1, 1, 2, 2}};
  EXPECT_EQ(chosen(edge), (Flags{1, 0, 0, 0, 1}));
  EXPECT_EQ(chosen(edge, {1, 1, 1, 0, 0}), (Flags{1, 1, 1, 0, 1}));
}

// Of a pane that covers half of what is behind it, each pixel shows both in as many samples.
TEST(PixelNoise, LeavesPixelsAloneThatLookLikeTheirNeighbours) {
  const std::vector<std::vector<float>> pane = {
      {1, 2, 1, 1, 2}, {2, 1, 2, 1, 1}, {1, 2, 1, 2, 2}, {2, 1, 2, 2, 1}};
  EXPECT_EQ(chosen(pane), (Flags{1, 1, 1, 1, 1}));
}

// Two samples of a pixel that differ, and two more that are their mean: its error is no longer
// visible.
TEST(PixelNoise, CountsTheSamplesOfEachRound) {
  PixelNoise noise(5, 1);
  Flags skipped(5);
  const float first[] = {1.0f, 1.0f, 1.0f, 2.0f, 2.0f}, second[] = {1.0f, 1.0f, 2.0f, 2.0f, 2.0f};
  std::vector<float> picture(5, 0.0f);
  for (const auto& sample : {first, second}) {
    for (std::size_t i = 0; i < picture.size(); ++i) picture[i] += 0.5f * sample[i];
    noise.add(picture, 0.5f, {});
  }
  noise.expose(0.0f);
  EXPECT_EQ(noise.choose(skipped), 3u);
  EXPECT_EQ(skipped, (Flags{1, 0, 0, 0, 1}));
  const std::vector<float> mean = picture;
  noise.scale(0.5f, skipped);
  for (std::size_t i = 1; i < 4; ++i) picture[i] *= 0.5f;
  for (int sample = 0; sample < 2; ++sample) {
    for (std::size_t i = 1; i < 4; ++i) picture[i] += 0.25f * mean[i];
    noise.add(picture, 0.25f, skipped);
  }
  EXPECT_EQ(noise.choose(skipped), 0u);
}

// An edge against a lamp is as visible as one against a wall, and one in the dark is not.
TEST(PixelNoise, IsThatOfADisplay) {
  const auto step = [](float dark, float bright) {
    return std::vector<std::vector<float>>{{dark, dark, dark, bright, bright},
                                           {dark, dark, bright, bright, bright}};
  };
  EXPECT_EQ(chosen(step(1.0f, 1e6f))[2], 0);
  EXPECT_EQ(chosen(step(1e6f, 2e6f))[2], 1);
  EXPECT_EQ(chosen(step(1e-6f, 2e-6f))[2], 1);
}

/// White unlit squares of 2 m that cover `alpha` of what is behind them, one behind the other
/// before a black one, turned so that no edge is along a row of pixels.
Scene stack_of_panes(int panes, float alpha) {
  constexpr float kTurn = 0.3f;
  Scene scene;
  scene.materials.resize(2);
  for (Material& material : scene.materials) material.unlit = true;
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color = glm::vec4(1.0f, 1.0f, 1.0f, alpha);
  scene.materials[1].base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  const auto add = [&](float z, int material) {
    const glm::vec3 u(std::cos(kTurn), std::sin(kTurn), 0.0f), v(-u.y, u.x, 0.0f), at(0, 0, z);
    scenes::MeshBuilder builder;
    builder.quad(at - u - v, at + u - v, at + u + v, at - u + v);
    scenes::add_object(scene, builder.take("pane", material));
  };
  for (int i = 0; i < panes; ++i) add(-0.1f * static_cast<float>(i), 0);
  add(-0.1f * static_cast<float>(panes), 1);
  scenes::add_camera(scene, "panes", {0.03f, 0.01f, 1.0f}, {0.03f, 0.01f, 0.0f}, 0.6f, 1.0f);
  return scene;
}

FrameSettings small(int samples, int most_samples) {
  FrameSettings settings;
  settings.width = settings.height = 48;
  settings.samples = samples;
  settings.most_samples = most_samples;
  return settings;
}

Image picture(const Scene& scene, const FrameSettings& settings) {
  const World world(scene);
  return *Renderer(world).render(scene.cameras.front(), settings).value().image.find("");
}

Metrics difference(const Image& image, const Image& truth) {
  return compare_images(image, truth, {.block = 1, .perceptual = false}).value();
}

TEST(FurtherSamples, TakeTheGrainOffStacksOfPanes) {
  const Scene panes = stack_of_panes(5, 0.3f);
  const Image truth = picture(panes, small(1024, 0));
  const Metrics four = difference(picture(panes, small(4, 0)), truth);
  const Metrics sixteen = difference(picture(panes, small(4, 16)), truth);
  EXPECT_LT(sixteen.relative_rmse, 0.5 * four.relative_rmse);
  EXPECT_NEAR(sixteen.mean_ratio, 1.0, 0.005);
}

TEST(FurtherSamples, SmoothEdges) {
  Scene edge = stack_of_panes(0, 0.0f);
  edge.environment.radiance = glm::vec3(1.0f);
  for (Camera& camera : edge.cameras) camera.vertical_fov = 2.0f;
  const Image truth = picture(edge, small(1024, 0));
  const Metrics four = difference(picture(edge, small(4, 0)), truth);
  const Metrics sixteen = difference(picture(edge, small(4, 16)), truth);
  const Metrics everywhere = difference(picture(edge, small(16, 0)), truth);
  EXPECT_LT(sixteen.relative_rmse, 0.6 * four.relative_rmse);
  EXPECT_LT(sixteen.relative_rmse, 1.2 * everywhere.relative_rmse);
}

// A pane has no grain in four samples, and must not get any.
TEST(FurtherSamples, LeavePlainPicturesAsTheyAre) {
  const Scene pane = stack_of_panes(1, 0.3f);
  EXPECT_EQ(picture(pane, small(4, 16)).pixels, picture(pane, small(4, 0)).pixels);
}

TEST(FurtherSamples, AreForWholePicturesThatStandAlone) {
  const Scene panes = stack_of_panes(5, 0.3f);
  const auto is_same = [&](auto change) {
    FrameSettings without = small(4, 0), with = small(4, 16);
    change(without);
    change(with);
    return picture(panes, with).pixels == picture(panes, without).pixels;
  };
  EXPECT_FALSE(is_same([](FrameSettings&) {}));
  EXPECT_TRUE(is_same([](FrameSettings& s) { s.rows = 20; }));
  EXPECT_TRUE(is_same([](FrameSettings& s) { s.temporal_antialiasing = true; }));
  EXPECT_TRUE(is_same([](FrameSettings& s) { s.most_samples = std::min(s.most_samples, 7); }));
  EXPECT_TRUE(is_same([](FrameSettings& s) { s.samples = 1; }));
}

// Light that is filtered, behind a blended pane and beside glass.
TEST(FurtherSamples, ComeCloserToManyInFilteredPicturesAndKeepTheirLight) {
  // Pixels whose samples differ less take no further ones: four samples of glass, at 0.019, have
  // little more noise
  constexpr double kHardlyVisible = 1.0 / 60.0;
  for (Scene scene : {test::box_behind_a_pane(), scenes::make("glass").value()}) {
    const test::Stage stage(std::move(scene));
    FieldSettings few_probes;
    few_probes.probe_count = glm::ivec3(5);
    few_probes.rays_per_probe = 64;
    const IrradianceField field = test::make_field(stage, few_probes, 4);
    const auto layers = [&](int samples, int most_samples) {
      FrameSettings settings = quality_settings(Quality::high);
      settings.width = settings.height = 48;
      settings.samples = samples;
      settings.most_samples = most_samples;
      Renderer renderer(stage.world, {.field = &field});
      return renderer.render(stage.scene.cameras.at(0), settings).value().image;
    };
    const LayeredImage truth = layers(64, 0), four = layers(4, 0), sixteen = layers(4, 16);
    const auto error = [&](const LayeredImage& image, const char* name) {
      return difference(*image.find(name), *truth.find(name));
    };
    EXPECT_LT(error(sixteen, "").relative_rmse,
              std::max(0.75 * error(four, "").relative_rmse, kHardlyVisible));
    for (const char* layer : {"direct", "indirect", "glossy", "albedo"}) {
      EXPECT_NEAR(error(sixteen, layer).mean_ratio, 1.0, 0.03) << layer;
    }
  }
}

}  // namespace
}  // namespace lambent::further_samples_test
