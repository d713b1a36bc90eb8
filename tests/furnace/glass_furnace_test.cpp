// SPDX-License-Identifier: Apache-2.0
// Glass takes no energy that it does not absorb, and lets as much light pass as the reference says.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "support/field_scenes.h"
#include "support/floor_under_a_pane.h"

namespace lambent::glass_furnace_test {
namespace {

// The project's bar for furnaces.
constexpr double kFurnaceTolerance = 0.005;
// The bar for light behind a pane.
constexpr double kPaneTolerance = 0.02;

// Of the field, which has all bounces after one: more are less noise.
constexpr int kFurnaceUpdates = 2;
constexpr int kPaneUpdates = 4;

// Samples a pixel of the reference. A furnace's mean is within 0.1 % of that by four times as many,
// that of light behind a pane within 0.5 %.
constexpr int kFurnaceSamples = 64;
constexpr int kPaneSamples = 256;

Material glass(float roughness, bool bounds_volume) {
  Material material;
  material.metallic = 0.0f;
  material.roughness = roughness;
  material.transmission = 1.0f;
  material.bounds_volume = bounds_volume;
  return material;
}

int add_material(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

void add_pane(Scene& scene, const Material& material) {
  scenes::MeshBuilder builder;
  builder.quad({0.0f, 0.0f, 1.5f}, {0.0f, 0.0f, -1.5f}, {0.0f, 2.5f, -1.5f}, {0.0f, 2.5f, 1.5f});
  scenes::add_object(scene, builder.take("pane", add_material(scene, material)));
}

void add_ball(Scene& scene, const Material& material) {
  constexpr int kSteps = 64;
  scenes::MeshBuilder builder;
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = 3.14159265f * static_cast<float>(i) / kSteps;
    const bool pole = i == 0 || i == kSteps;
    profile.emplace_back(pole ? 0.0f : 0.6f * std::sin(angle), -0.6f * std::cos(angle));
  }
  builder.lathe({-0.7f, 1.1f, 0.0f}, profile, 2 * kSteps);
  scenes::add_object(scene, builder.take("ball", add_material(scene, material)));
}

/// A skewed block of diamond, within which light is reflected many times.
void add_block(Scene& scene) {
  Material diamond = glass(0.0f, true);
  diamond.ior = 2.4f;
  const glm::vec3 o(-1.2f, 0.5f, -0.6f);
  const glm::vec3 x(0.9f, 0.0f, 0.2f), y(0.35f, 1.0f, 0.1f), z(0.1f, 0.3f, 0.8f);
  scenes::MeshBuilder builder;
  builder.quad(o, o + y, o + x + y, o + x);
  builder.quad(o + z, o + x + z, o + x + y + z, o + y + z);
  builder.quad(o, o + z, o + y + z, o + y);
  builder.quad(o + x, o + x + y, o + x + y + z, o + x + z);
  builder.quad(o, o + x, o + x + z, o + z);
  builder.quad(o + y, o + y + z, o + x + y + z, o + x + y);
  scenes::add_object(scene, builder.take("block", add_material(scene, diamond)));
}

void add_room(Scene& scene, const glm::vec3& albedo, const glm::vec3& emission) {
  scenes::MeshBuilder builder;
  builder.room({-2.0f, 0.0f, -1.5f}, {2.0f, 2.5f, 1.5f});
  scenes::add_object(scene,
                     builder.take("room", scenes::add_lambert(scene, "wall", albedo, emission)));
  scenes::add_camera(scene, "room", {1.8f, 1.4f, 1.0f}, {-1.0f, 1.1f, -0.2f}, 0.9f, 1.0f);
}

/// A room whose radiance is 1 everywhere.
Scene furnace() {
  Scene scene;
  add_room(scene, glm::vec3(0.5f), glm::vec3(0.5f));
  return scene;
}

/// A lamp on one side of a room; what is right of x = 0 is behind the pane, if there is one.
Scene lit_room() {
  Scene scene;
  add_room(scene, {0.7f, 0.6f, 0.5f}, glm::vec3(0.0f));
  scenes::MeshBuilder builder;
  builder.quad({-1.6f, 2.48f, -0.4f}, {-1.0f, 2.48f, -0.4f}, {-1.0f, 2.48f, 0.4f},
               {-1.6f, 2.48f, 0.4f});
  scenes::add_object(scene,
                     builder.take("lamp", scenes::add_lambert(scene, "lamp", glm::vec3(0.0f),
                                                              glm::vec3(12.0f, 11.0f, 9.0f))));
  return scene;
}

double mean_of(const LayeredImage& image, const char* layer, int channel = -1) {
  const Image& pixels = *image.find(layer);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels.pixels.size(); ++i) {
    if (channel >= 0 && i % 3 != static_cast<std::size_t>(channel)) continue;
    sum += pixels.pixels[i];
    ++count;
  }
  return sum / static_cast<double>(count);
}

LayeredImage render(const test::Stage& stage, int samples, int updates) {
  FieldSettings settings = test::exact_formats();
  settings.rays_per_probe = 256;
  const IrradianceField field = test::make_field(stage, settings, updates);
  FrameSettings frame;
  frame.width = frame.height = 48;
  frame.samples = samples;
  return Renderer(stage.world, {.field = &field}).render(stage.scene.cameras[0], frame)->image;
}

LayeredImage render_reference_of(const test::Stage& stage, int samples) {
  ReferenceSettings settings;
  settings.width = settings.height = 48;
  settings.samples = samples;
  return render_reference(stage.world, stage.scene.cameras[0], settings).image;
}

/// Holds that both methods see nothing of what stands in a furnace, `least` of whose light comes
/// through glass.
void expect_unseen(Scene scene, double least) {
  const test::Stage stage(std::move(scene));
  const LayeredImage image = render(stage, 16, kFurnaceUpdates);
  const LayeredImage reference = render_reference_of(stage, kFurnaceSamples);
  std::printf("frame %.4f, reference %.4f\n", mean_of(image, ""), mean_of(reference, ""));
  EXPECT_NEAR(mean_of(image, ""), 1.0, kFurnaceTolerance);
  EXPECT_GT(mean_of(image, "transmission"), least);
  EXPECT_NEAR(mean_of(reference, ""), 1.0, kFurnaceTolerance);
}

TEST(GlassFurnace, APaneTakesNothing) {
  Scene scene = furnace();
  add_pane(scene, glass(0.0f, false));
  expect_unseen(std::move(scene), 0.3);
}

// Light that a microfacet sends into another one is lost, by glTF's formulas.
TEST(GlassFurnace, ARoughPaneTakesWhatTheReferenceSays) {
  Scene scene = furnace();
  add_pane(scene, glass(0.3f, false));
  const test::Stage stage(std::move(scene));
  const double found = mean_of(render(stage, 16, kFurnaceUpdates), "");
  const double expected = mean_of(render_reference_of(stage, kFurnaceSamples), "");
  std::printf("frame %.4f, reference %.4f\n", found, expected);
  EXPECT_NEAR(found, expected, kFurnaceTolerance);
}

TEST(GlassFurnace, ABallTakesNothing) {
  Scene scene = furnace();
  add_ball(scene, glass(0.0f, true));
  expect_unseen(std::move(scene), 0.05);
}

// Paths that ended at the twelfth surface took 2 % of the picture.
TEST(GlassFurnace, ABlockOfDiamondTakesNothing) {
  Scene scene = furnace();
  add_block(scene);
  expect_unseen(std::move(scene), 0.05);
}

TEST(GlassPane, LetsAsMuchLightPassAsTheReferenceSays) {
  Scene scene = lit_room();
  Material pane = glass(0.0f, false);
  pane.base_color = glm::vec4(0.5f, 0.9f, 0.7f, 1.0f);
  add_pane(scene, pane);
  // The camera looks at the half behind the pane alone
  scene.cameras.clear();
  scenes::add_camera(scene, "behind", {0.1f, 1.4f, 1.3f}, {1.9f, 0.9f, -0.9f}, 0.9f, 1.0f);
  const test::Stage stage(std::move(scene));
  const LayeredImage found = render(stage, 16, kPaneUpdates);
  const LayeredImage expected = render_reference_of(stage, kPaneSamples);
  for (const char* layer : {"direct", "irradiance", "indirect"}) {
    for (int channel = 0; channel < 3; ++channel) {
      const double reference = mean_of(expected, layer, channel);
      const double ratio = mean_of(found, layer, channel) / reference;
      std::printf("%s %d: ratio %.4f\n", layer, channel, ratio);
      EXPECT_GT(reference, 1e-3) << layer;
      EXPECT_NEAR(ratio, 1.0, kPaneTolerance) << layer << ' ' << channel;
    }
  }
}

TEST(GlassPane, ShowsWhatIsBehindIt) {
  Scene scene = lit_room();
  Material pane = glass(0.0f, false);
  pane.base_color = glm::vec4(0.5f, 0.9f, 0.7f, 1.0f);
  add_pane(scene, pane);
  const test::Stage stage(std::move(scene));
  const LayeredImage found = render(stage, 16, kPaneUpdates);
  const LayeredImage expected = render_reference_of(stage, kPaneSamples);
  for (int channel = 0; channel < 3; ++channel) {
    const double reference = mean_of(expected, "transmission", channel);
    const double ratio = mean_of(found, "transmission", channel) / reference;
    std::printf("channel %d: ratio %.4f\n", channel, ratio);
    EXPECT_GT(reference, 1e-3);
    EXPECT_NEAR(ratio, 1.0, kPaneTolerance) << channel;
  }
}

// The lamp's light comes by the floor's own rays and by its samples of emitters. Both weigh it by
// how many samples the floor takes, and not by how many the surfaces take that its rays meet.
TEST(GlassPane, CoatsHaveAllOfALampBehindItWhateverTheNumbersOfSamples) {
  const test::Stage stage(test::floor_under_a_pane());
  const double expected = mean_of(render_reference_of(stage, kPaneSamples), "");
  ASSERT_GT(expected, 0.05);
  const IrradianceField field = test::make_field(stage, test::exact_formats(), 4);
  FrameSettings frame;
  frame.width = frame.height = 48;
  frame.samples = 64;
  for (const auto& [own, reflected] : {std::pair{1, 16}, std::pair{16, 1}, std::pair{4, 4}}) {
    frame.emissive_samples = own;
    frame.reflected_emissive_samples = reflected;
    const LayeredImage image =
        Renderer(stage.world, {.field = &field}).render(stage.scene.cameras[0], frame)->image;
    const double ratio = mean_of(image, "") / expected;
    std::printf("%d and %d samples: ratio %.4f\n", own, reflected, ratio);
    EXPECT_NEAR(ratio, 1.0, kPaneTolerance) << own << ", " << reflected;
  }
}

}  // namespace
}  // namespace lambent::glass_furnace_test
