// SPDX-License-Identifier: Apache-2.0
// The light of lamps that differ in colour, and what the filter divides it by.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "compose/pixel_math.h"
#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
#include "raytracing/surface_math.h"
#include "scene/light_sampling.h"
#include "scene/light_tree/light_tree.h"
#include "scene/light_tree/unoccluded_light.h"
#include "shared/color.h"
#include "shared/constants.h"
#include "support/coloured_lamps.h"

namespace lambent::coloured_lamps_test {
namespace {

TEST(ColouredLamps, KeepTheirColoursApart) {
  const Scene scene = test::two_lamps();
  const World world(scene);
  Renderer renderer(world);
  FrameSettings settings = quality_settings(Quality::interactive);
  settings.width = settings.height = 64;
  settings.emissive_samples = 16;
  FrameSettings converged = settings;
  converged.denoise = false;
  converged.emissive_samples = 256;
  const RenderedFrame truth = renderer.render(scene.cameras[0], converged).value();
  const RenderedFrame filtered = renderer.render(scene.cameras[0], settings).value();
  const Metrics found = compare_images(*filtered.image.find("direct"), *truth.image.find("direct"),
                                       {.block = 4, .perceptual = false})
                            .value();
  std::printf("relative RMSE %.4f\n", found.relative_rmse);
  EXPECT_LT(found.relative_rmse, 0.032);
}

TEST(ColouredLamps, AreInTheUnoccludedLight) {
  const Scene scene = test::two_lamps();
  const EmissiveTriangles emissive(scene);
  const LightTree tree(scene, emissive);
  const vec3 up(0.0f, 1.0f, 0.0f);
  const auto light = [&](float x) { return unoccluded_light(tree, emissive, {x, 0.0f, 0.0f}, up); };
  // Below a lamp, and where both send the same
  const vec3 below = light(-0.95f), between = light(0.0f), both = test::kPink + test::kBlue;
  EXPECT_GT(below.x / luminance(below), 0.9f * test::kPink.x / luminance(test::kPink));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(between[c] / luminance(between), both[c] / luminance(both), 1e-3f) << c;
  }
}

// A single sample of a lamp that is rarer than the others' colours is limited as all light is, and
// its variance is that of the light that is filtered.
TEST(ColouredLamps, LimitSamplesOfRareColours) {
  const Reflectance white = lambert_reflectance(vec3(1.0f));
  const vec3 red(1.0f, 0.0f, 0.0f), blue(0.0f, 0.0f, 1.0f);
  const FilteredEmitter emitter = filtered_emitter(white, blue, red);
  EXPECT_LE(luminance(emitter.light), kMostOverUnoccluded * 1.001f);
  EXPECT_NEAR(emitter.scale * luminance(blue), luminance(emitter.light), 1e-4f);
  EXPECT_EQ(emitter.found, luminance(blue));
  const vec3 shown = emitter.light * emitter.albedo;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], blue[c], 1e-5f) << c;
}

TEST(ColouredLamps, AreTintedAsTheirTextures) {
  Scene scene = test::two_lamps();
  Texture texture;
  texture.srgb = false;
  texture.levels.push_back({2, 1, {255, 0, 0, 255, 0, 0, 255, 255}});
  scene.textures.push_back(texture);
  for (Material& material : scene.materials) material.emission_texture.texture = 0;
  // The whole quad has the colour of one texel, or the mean of both, by its texture coordinates
  scene.materials[1].emission = scene.materials[2].emission = vec3(1.0f);
  scene.meshes[1].uvs[0] = {{0.25f, 0.5f}, {0.25f, 0.5f}, {0.25f, 0.5f}, {0.25f, 0.5f}};
  scene.meshes[2].uvs[0] = {{0.25f, 0.5f}, {0.25f, 0.5f}, {0.75f, 0.5f}, {0.75f, 0.5f}};
  const EmissiveTriangles emissive(scene);
  vec3 mixed(0.0f);
  for (std::size_t e = 0; e < emissive.size(); ++e) {
    const EmitterRecord& emitter = emissive.entries()[e];
    const vec3& tint = emissive.tints()[e];
    EXPECT_NEAR(luminance(tint), 1.0f, 1e-5f);
    if (emitter.instance == 1) {
      EXPECT_NEAR(tint.x, 1.0f / luminance(vec3(1.0f, 0.0f, 0.0f)), 1e-3f);
    } else {
      mixed += emitter.probability * tint;
    }
  }
  EXPECT_NEAR(mixed.x / mixed.z, 1.0f, 0.15f);
}

}  // namespace
}  // namespace lambent::coloured_lamps_test
