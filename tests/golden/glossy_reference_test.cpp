// SPDX-License-Identifier: Apache-2.0
// Reflections against our own reference: what other renderers get wrong is a test each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "support/field_scenes.h"

namespace lambent::glossy_reference_test {
namespace {

/// A room, grey but for a red wall behind the camera, lit by a lamp; light also comes from bounces.
Scene room() {
  Scene scene;
  const int grey = scenes::add_lambert(scene, "grey", glm::vec3(0.6f));
  const int red = scenes::add_lambert(scene, "red", {0.7f, 0.1f, 0.1f});
  const int lamp = scenes::add_lambert(scene, "lamp", glm::vec3(0.0f), glm::vec3(8.0f));
  scenes::MeshBuilder builder;
  builder.room({-2.0f, 0.0f, -3.0f}, {2.0f, 3.0f, 3.0f});
  scenes::add_object(scene, builder.take("room", grey));
  builder.box({-1.99f, 0.01f, 2.9f}, {1.99f, 2.99f, 2.98f});
  scenes::add_object(scene, builder.take("behind", red));
  builder.box({-0.6f, 2.9f, -0.6f}, {0.6f, 2.95f, 0.6f});
  scenes::add_object(scene, builder.take("lamp", lamp));
  scenes::add_camera(scene, "camera", {0.0f, 1.4f, 1.5f}, {0.0f, 1.2f, -3.0f}, 0.8f, 1.0f);
  return scene;
}

Material metal(float roughness) {
  Material material;
  material.base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
  material.metallic = 1.0f;
  material.roughness = roughness;
  return material;
}

/// The room with a metal plate at its far end; `facing` puts another behind the camera.
Scene room_with_plate(float roughness, bool facing = false) {
  Scene scene = room();
  scene.materials.push_back(metal(roughness));
  const int plate = static_cast<int>(scene.materials.size()) - 1;
  scenes::MeshBuilder builder;
  builder.box({-1.5f, 0.4f, -2.95f}, {1.5f, 2.4f, -2.9f});
  scenes::add_object(scene, builder.take("plate", plate));
  if (facing) {
    builder.box({-1.5f, 0.4f, 2.8f}, {1.5f, 2.4f, 2.85f});
    scenes::add_object(scene, builder.take("facing", plate));
  }
  return scene;
}

/// The room with a mirror, its lamp hidden from below, and shelves on the wall behind the camera.
Scene room_with_shelves() {
  Scene scene = room_with_plate(0.0f);
  scenes::MeshBuilder builder;
  builder.box({-0.8f, 2.5f, -0.8f}, {0.8f, 2.53f, 0.8f});
  scenes::add_object(scene, builder.take("shade", 0));
  for (const float height : {0.5f, 0.9f, 1.3f, 1.7f}) {
    builder.box({-1.6f, height, 2.5f}, {1.6f, height + 0.04f, 2.9f});
    scenes::add_object(scene, builder.take("shelf", 0));
    for (int i = 0; i < 5; ++i) {
      const glm::vec3 foot(-1.4f + 0.6f * static_cast<float>(i), height + 0.04f, 2.6f);
      builder.box(foot, foot + glm::vec3(0.16f, 0.2f, 0.12f));
      scenes::add_object(scene, builder.take("thing", 0));
    }
  }
  return scene;
}

struct Pictures {
  LayeredImage ours, reference;
};

Pictures pictures_of(const test::Stage& stage, FrameSettings frame, int reference_samples,
                     int updates) {
  FieldSettings settings;
  settings.probe_count = {7, 5, 9};
  settings.rays_per_probe = 144;
  const IrradianceField field = test::make_field(stage, settings, updates);
  ReferenceSettings by;
  by.width = frame.width;
  by.height = frame.height;
  by.samples = reference_samples;
  by.layer_errors = true;
  const Camera& camera = stage.scene.cameras[0];
  return {Renderer(stage.world, {.field = &field}).render(camera, frame).value().image,
          render_reference(stage.world, camera, by).image};
}

Pictures pictures_of(const test::Stage& stage, int side, int samples, int reference_samples,
                     int updates = 8) {
  FrameSettings frame;
  frame.width = frame.height = side;
  frame.samples = samples;
  return pictures_of(stage, frame, reference_samples, updates);
}

Metrics glossy_metrics(const Pictures& pictures, int block) {
  return compare_images(*pictures.ours.find("glossy"), *pictures.reference.find("glossy"),
                        {.block = block,
                         .standard_error = pictures.reference.find("glossy.error"),
                         .perceptual = false})
      .value();
}

/// The largest pixel of our picture over the largest around it in the reference.
double largest_spark(const Pictures& pictures, double least) {
  constexpr int kAround = 2;  // [pixels]
  const Image& ours = *pictures.ours.find("glossy");
  const Image& reference = *pictures.reference.find("glossy");
  double largest = 0.0;
  for (int y = 0; y < ours.height; ++y) {
    for (int x = 0; x < ours.width; ++x) {
      double around = least;
      for (int v = std::max(0, y - kAround); v <= std::min(ours.height - 1, y + kAround); ++v) {
        for (int u = std::max(0, x - kAround); u <= std::min(ours.width - 1, x + kAround); ++u) {
          around = std::max<double>(around, reference.at(u, v)[1]);
        }
      }
      largest = std::max(largest, ours.at(x, y)[1] / around);
    }
  }
  return largest;
}

// A mirror shows the wall behind the camera, lit by all bounces; renderers that reflect the screen
// or leave GI out of reflections show another one.
TEST(Reflections, ShowWhatIsOffTheScreenUnderAllBounces) {
  // Two blocks of the picture show the lamp, whose noise is nearly all of the error where samples
  // are few: at roughness 0.2 and 8 samples the error is 0.03 to 0.12, from seed to seed. A mirror
  // shows the lamp's sharp edges and needs more
  constexpr int kSamples = 32, kSamplesOfMirror = 256;
  // Their noise is taken out of the error of blocks; the means are within 0.7 % of those by 1024
  constexpr int kReferenceSamples = 256;
  for (const float roughness : {0.0f, 0.2f, 0.4f, 0.6f, 0.8f}) {
    const test::Stage stage(room_with_plate(roughness));
    const int samples = roughness == 0.0f ? kSamplesOfMirror : kSamples;
    const Metrics metrics = glossy_metrics(pictures_of(stage, 48, samples, kReferenceSamples), 8);
    const double rmse = metrics.noise_corrected_relative_rmse.value_or(metrics.relative_rmse);
    std::printf("roughness %.1f: mean ratio %.4f, relative RMSE %.4f\n", roughness,
                metrics.mean_ratio, rmse);
    // The bar for means is 0.98 to 1.02, of which the field's own error here is 1.5 %
    EXPECT_GE(metrics.mean_ratio, 0.965) << roughness;
    EXPECT_LE(metrics.mean_ratio, 1.035) << roughness;
    EXPECT_LE(rmse, roughness == 0.0f ? 0.03 : 0.08) << roughness;
  }
}

// In a mirror as well, what is smaller than the field's cells has its own light and shade.
TEST(Reflections, ShowWhatThingsSmallerThanCellsGather) {
  const test::Stage stage(room_with_shelves());
  FrameSettings frame = quality_settings(Quality::high);
  frame.width = frame.height = 48;
  const Metrics metrics = glossy_metrics(pictures_of(stage, frame, 1024, 4), 8);
  const double rmse = metrics.noise_corrected_relative_rmse.value_or(metrics.relative_rmse);
  std::printf("shelves: mean ratio %.4f, relative RMSE %.4f\n", metrics.mean_ratio, rmse);
  // Lookups alone: 1.024 and 0.064
  EXPECT_GE(metrics.mean_ratio, 0.98);
  EXPECT_LE(metrics.mean_ratio, 1.02);
  EXPECT_LE(rmse, 0.055);
}

TEST(Reflections, OfMirrorsInMirrorsGoOn) {
  const test::Stage stage(room_with_plate(0.0f, true));
  const Metrics metrics = glossy_metrics(pictures_of(stage, 48, 8, 256), 8);
  std::printf("hall of mirrors: mean ratio %.4f\n", metrics.mean_ratio);
  // Where paths ended after four reflections, with the field's light, it was 1.034
  EXPECT_GE(metrics.mean_ratio, 0.98);
  EXPECT_LE(metrics.mean_ratio, 1.02);
}

// Neither lamps that rays meet by chance nor silhouettes in mirrors leave sparks or halos.
TEST(Reflections, HaveNoSparks) {
  const test::Stage stage("spheres");
  const Pictures pictures = pictures_of(stage, 96, 16, 256);
  const Metrics metrics = glossy_metrics(pictures, 1);
  const double largest = largest_spark(pictures, metrics.mean_b);
  std::printf("largest pixel over those around it: %.3f\n", largest);
  EXPECT_LE(largest, 2.0);
}

// Where rays at every pixel, then rays at all, give way to others, nobody sees it.
TEST(Reflections, ChangeWithRoughnessInNoLargerStepsThanTheReferences) {
  constexpr int kSteps = 64, kSide = 24;
  // The field holds all bounces after one, and its noise, of the same rays at each step, cancels
  constexpr int kUpdates = 2;
  // With 16 samples, noise doubles our largest step
  constexpr int kSamples = 64;
  const auto mean_of = [](const LayeredImage& image) {
    const Image& glossy = *image.find("glossy");
    double sum = 0.0;
    for (const float v : glossy.pixels) sum += v;
    return sum / static_cast<double>(glossy.pixels.size());
  };
  double largest = 0.0, largest_of_reference = 0.0;
  double before = 0.0, reference_before = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const test::Stage stage(room_with_plate(static_cast<float>(i) / (kSteps - 1)));
    const Pictures pictures = pictures_of(stage, kSide, kSamples, kSamples, kUpdates);
    const double now = mean_of(pictures.ours), reference = mean_of(pictures.reference);
    if (i > 0) {
      largest = std::max(largest, std::abs(now / before - 1.0));
      largest_of_reference =
          std::max(largest_of_reference, std::abs(reference / reference_before - 1.0));
    }
    before = now;
    reference_before = reference;
  }
  std::printf("largest step %.4f, of the reference %.4f\n", largest, largest_of_reference);
  EXPECT_LE(largest, 1.5 * largest_of_reference);
}

// No filter takes the noise from what a mirror shows: samples of the lamp at its hits do.
TEST(Reflections, AreSmootherWithMoreSamplesOfWhatEmits) {
  const test::Stage stage(room_with_plate(0.0f));
  FieldSettings settings;
  settings.probe_count = {5, 4, 6};
  const IrradianceField field = test::make_field(stage, settings, 2);
  const auto noise_with = [&](int samples) {
    FrameSettings frame;
    frame.width = frame.height = 32;
    frame.reflected_emissive_samples = samples;
    Renderer renderer(stage.world, {.field = &field});
    const LayeredImage one = renderer.render(stage.scene.cameras[0], frame).value().image;
    frame.seed = 2;
    const LayeredImage other = renderer.render(stage.scene.cameras[0], frame).value().image;
    return compare_images(*one.find("glossy"), *other.find("glossy"), {.perceptual = false})
        .value()
        .relative_rmse;
  };
  const double few = noise_with(1), many = noise_with(16);
  std::printf("noise with 1 sample %.4f, with 16 %.4f\n", few, many);
  // What is left is of the gap between lamp and ceiling, where few samples arrive
  EXPECT_LT(many, 0.7 * few);
}

}  // namespace
}  // namespace lambent::glossy_reference_test
