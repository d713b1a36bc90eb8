// SPDX-License-Identifier: Apache-2.0
// What the reference promises of itself: no bias whichever way light is found, an honest error, the
// same bits always.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <string>
#include <vector>

#include "reference/path_tracer.h"
#include "shared/constants.h"
#include "shared/sampling.h"
#include "support/hand_made.h"
#include "support/panels.h"

namespace lambent::reference_estimator_test {
namespace {

using reference::Strategy;
using test::add;
using test::add_room;
using test::lambert;
using test::quad;

// Estimates of the same mean may differ by this many standard errors of their difference.
constexpr double kSigmas = 4.5;

Material rough_plastic(const glm::vec3& albedo, float roughness) {
  Material material;
  material.base_color = glm::vec4(albedo, 1.0f);
  material.metallic = 0.0f;
  material.roughness = roughness;
  return material;
}

// A room with a lamp, a glossy sphere and a mirror-like one, under a sky map seen through the open
// front.
Scene lamp_and_spheres() {
  Scene scene;
  scene.materials = {lambert({0.7f, 0.6f, 0.5f}),
                     lambert(glm::vec3(0.2f), glm::vec3(6.0f, 5.0f, 4.0f)),
                     rough_plastic({0.5f, 0.2f, 0.1f}, 0.4f), Material{}};
  scene.materials[3].base_color = {0.9f, 0.8f, 0.7f, 1.0f};
  scene.materials[3].roughness = 0.3f;
  add_room(scene, 2.0f, 0);
  scene.instances.pop_back();  // the +Z wall
  add(scene, quad({-0.4f, 0.95f, -0.4f}, {0.8f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.8f}, 1));
  const auto at = [](const glm::vec3& position) {
    glm::mat4 m(1.0f);
    m[3] = glm::vec4(position, 1.0f);
    return m;
  };
  add(scene, test::sphere(0.35f, 24, 2), at({-0.45f, -0.6f, 0.0f}));
  add(scene, test::sphere(0.35f, 24, 3), at({0.45f, -0.6f, -0.2f}));
  scene.environment.radiance = glm::vec3(1.0f);
  scene.environment.map = Image(16, 8, 3);
  for (std::size_t i = 0; i < scene.environment.map.pixels.size(); ++i) {
    scene.environment.map.pixels[i] = 0.2f + 0.05f * static_cast<float>(i % 7);
  }
  // A bright window in the sky, towards +Z
  for (int k = 0; k < 3; ++k) scene.environment.map.at(0, 3)[k] = 20.0f;
  return scene;
}

const Camera kInto = look_at({0.0f, 0.0f, 3.5f}, {0.0f, -0.1f, 0.0f}, 0.65f);

ReferenceSettings small(int samples, std::uint32_t seed) {
  ReferenceSettings settings;
  settings.width = 32;
  settings.height = 32;
  settings.samples = samples;
  settings.seed = seed;
  settings.layer_errors = true;
  return settings;
}

struct MeanAndError {
  double mean, error;
};

MeanAndError mean_of(const ReferenceResult& result, const std::string& name) {
  const Image& image = *result.image.find(name);
  const Image& error = *result.image.find(name.empty() ? "error" : name + ".error");
  double sum = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    sum += image.pixels[i];
    variance += static_cast<double>(error.pixels[i]) * error.pixels[i];
  }
  // The three channels of a pixel share their noise
  const auto count = static_cast<double>(image.pixels.size());
  return {sum / count, std::sqrt(3.0 * variance) / count};
}

void expect_same_means_by_every_strategy(const Scene& scene,
                                         const std::vector<const char*>& layers) {
  const World world(scene);
  ReferenceSettings settings = small(256, 3);
  const ReferenceResult combined = render_reference(world, kInto, settings);
  for (const Strategy strategy : {Strategy::scatter, Strategy::light}) {
    settings.strategy = strategy;
    settings.seed += 1;
    const ReferenceResult other = render_reference(world, kInto, settings);
    for (const char* layer : layers) {
      const MeanAndError a = mean_of(combined, layer), b = mean_of(other, layer);
      EXPECT_LT(std::abs(a.mean - b.mean), kSigmas * std::hypot(a.error, b.error))
          << "layer " << layer;
      EXPECT_LT(std::hypot(a.error, b.error), 0.05 * a.mean) << "layer " << layer;
    }
  }
}

const std::vector<const char*> kReflected = {"", "direct", "indirect", "irradiance", "glossy"};

TEST(ReferenceEstimator, EveryStrategyHasTheSameMeanInEveryLayer) {
  expect_same_means_by_every_strategy(lamp_and_spheres(), kReflected);
}

// A frosted pane before a frosted ball, with lamp and sky on both sides of the pane.
TEST(ReferenceEstimator, EveryStrategyHasTheSameMeanBehindRoughGlass) {
  Scene scene = lamp_and_spheres();
  Material& ball = scene.materials[2];
  ball.base_color = glm::vec4(1.0f);
  ball.transmission = 1.0f;
  ball.bounds_volume = true;
  scene.materials.push_back(ball);
  scene.materials.back().bounds_volume = false;
  add(scene, quad({-1.0f, -1.0f, 0.6f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}, 4));
  expect_same_means_by_every_strategy(scene, {"", "transmission", "glossy"});
}

TEST(ReferenceEstimator, EveryStrategyHasTheSameMeanUnderALampThatIsDrawnInPieces) {
  Scene scene = lamp_and_spheres();
  scene.textures = {test::panel_texture(64)};
  scene.materials[1].emission_texture.texture = 0;
  scene.materials[1].emission *= 4.0f;
  expect_same_means_by_every_strategy(scene, kReflected);
}

TEST(ReferenceEstimator, CombinedStrategyIsLeastNoisy) {
  const Scene scene = lamp_and_spheres();
  const World world(scene);
  ReferenceSettings settings = small(64, 3);
  const double combined = render_reference(world, kInto, settings).relative_standard_error;
  settings.strategy = Strategy::scatter;
  EXPECT_LT(combined, render_reference(world, kInto, settings).relative_standard_error);
  settings.strategy = Strategy::light;
  EXPECT_LT(combined, render_reference(world, kInto, settings).relative_standard_error);
}

TEST(ReferenceEstimator, ReportsTheErrorThatIndependentImagesShow) {
  const Scene scene = lamp_and_spheres();
  const World world(scene);
  const ReferenceResult a = render_reference(world, kInto, small(64, 10));
  const ReferenceResult b = render_reference(world, kInto, small(64, 11));
  // Direct light has a few pixels beside the lamp that outweigh all others: too few to compare
  for (const char* layer : {"", "indirect", "irradiance"}) {
    const std::string error_name = *layer == '\0' ? "error" : std::string(layer) + ".error";
    const Image &x = *a.image.find(layer), &y = *b.image.find(layer);
    const Image &ex = *a.image.find(error_name), &ey = *b.image.find(error_name);
    double shown = 0.0, reported = 0.0;
    for (std::size_t i = 0; i < x.pixels.size(); ++i) {
      shown += std::pow(x.pixels[i] - y.pixels[i], 2.0);
      reported += std::pow(ex.pixels[i], 2.0) + std::pow(ey.pixels[i], 2.0);
    }
    EXPECT_NEAR(std::sqrt(shown / reported), 1.0, 0.1) << "layer " << layer;
  }
}

TEST(ReferenceEstimator, ImageIsTheSumOfItsParts) {
  const Scene scene = lamp_and_spheres();
  const World world(scene);
  const ReferenceResult result = render_reference(world, kInto, small(4, 1));
  const auto& layer = [&](const char* name) -> const std::vector<float>& {
    return result.image.find(name)->pixels;
  };
  for (std::size_t i = 0; i < layer("").size(); ++i) {
    ASSERT_EQ(layer("")[i], layer("direct")[i] + layer("indirect")[i] + layer("glossy")[i] +
                                layer("emission")[i]);
  }
}

TEST(ReferenceEstimator, SameBitsForAnyNumberOfThreads) {
  const Scene scene = lamp_and_spheres();
  const World world(scene);
  const ReferenceResult many = render_reference(world, kInto, small(8, 1));
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const ReferenceResult one = render_reference(world, kInto, small(8, 1));
  EXPECT_EQ(many.rays, one.rays);
  for (const Layer& layer : many.image.layers) {
    EXPECT_EQ(layer.image.pixels, one.image.find(layer.name)->pixels) << layer.name;
  }
}

TEST(ReferenceEstimator, SeedsAndProgressDoWhatTheySay) {
  const Scene scene = lamp_and_spheres();
  const World world(scene);
  double last = 0.0;
  const ReferenceResult a =
      render_reference(world, kInto, small(4, 1), [&](std::string_view, double done) {
        EXPECT_GE(done, last);
        last = done;
      });
  EXPECT_DOUBLE_EQ(last, 1.0);
  EXPECT_NE(a.image.find("")->pixels,
            render_reference(world, kInto, small(4, 2)).image.find("")->pixels);
  EXPECT_TRUE(std::isinf(render_reference(world, kInto, small(1, 1)).relative_standard_error));
}

TEST(ReferenceEstimator, UniformMapIsTheConstantSky) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f)), rough_plastic(glm::vec3(0.5f), 0.3f)};
  add(scene, test::sphere(1.0f, 24, 1));
  add(scene, quad({-2.0f, -1.0f, -2.0f}, {0.0f, 0.0f, 4.0f}, {4.0f, 0.0f, 0.0f}, 0));
  scene.environment.radiance = {1.0f, 2.0f, 3.0f};
  const Camera camera = look_at({0.0f, 1.0f, 5.0f}, {0.0f, 0.0f, 0.0f}, 0.7f);
  const ReferenceResult constant = render_reference(World(scene), camera, small(128, 1));
  scene.environment.map = Image(8, 4, 3);
  for (float& value : scene.environment.map.pixels) value = 1.0f;
  const ReferenceResult mapped = render_reference(World(scene), camera, small(128, 2));
  for (const char* layer : {"", "indirect", "irradiance", "glossy"}) {
    const MeanAndError a = mean_of(constant, layer), b = mean_of(mapped, layer);
    EXPECT_LT(std::hypot(a.error, b.error), 0.025 * a.mean) << "layer " << layer;
    EXPECT_LT(std::abs(a.mean - b.mean), kSigmas * std::hypot(a.error, b.error))
        << "layer " << layer;
  }
}

TEST(ReferenceEstimator, BouncesAddTheTermsOfTheGeometricSeries) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(1.0f))};
  add_room(scene, 2.0f, 0);
  const World world(scene);
  const SurfacePoint point{{0.0f, -1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  double expected = 1.0, term = 1.0;
  for (const int bounces : {0, 1, 2, 5}) {
    expected = 0.0;
    term = 1.0;
    for (int k = 0; k <= bounces; ++k, term *= 0.5) expected += term;
    const Estimate e = reference_irradiance(world, {&point, 1}, 4096, 5, LightKind::all,
                                            Strategy::combined, bounces)[0];
    EXPECT_NEAR(e.mean.x / (expected * kPi), 1.0, 0.01) << bounces;
  }
}

TEST(ReferenceEstimator, IrradianceOfABlackSurfaceIsFinite) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.0f)), Material{}};
  scene.materials[1].roughness = 0.1f;  // a metal: no diffuse part at all
  scene.environment.radiance = glm::vec3(1.0f);
  for (const int material : {0, 1}) {
    scene.meshes.clear();
    scene.instances.clear();
    add(scene, quad({-1.0f, 0.0f, -1.0f}, {0.0f, 0.0f, 2.0f}, {2.0f, 0.0f, 0.0f}, material));
    const Camera camera = look_at({0.0f, 2.0f, 0.5f}, {0.0f, 0.0f, 0.0f}, 0.1f);
    const ReferenceResult result = render_reference(World(scene), camera, small(256, 1));
    EXPECT_NEAR(mean_of(result, "irradiance").mean / kPi, 1.0, 0.01) << material;
    EXPECT_EQ(mean_of(result, "indirect").mean, 0.0);
  }
}

TEST(ReferenceEstimator, SeeThroughSurfacesDimBothWaysOfFindingLight) {
  // A lamp behind a half-covering pane, as seen from the floor
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.0f), glm::vec3(1.0f)), lambert(glm::vec3(0.0f))};
  scene.materials[1].base_color.a = 0.25f;
  scene.materials[1].alpha_mode = AlphaMode::blend;
  add(scene, quad({-1.0f, 2.0f, -1.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f}, 0));
  const SurfacePoint point{{0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  const float open = reference_irradiance(World(scene), {&point, 1}, 1 << 14, 1)[0].mean.x;
  add(scene, quad({-3.0f, 1.0f, -3.0f}, {6.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.0f}, 1));
  const World world(scene);
  for (const Strategy strategy : {Strategy::combined, Strategy::scatter, Strategy::light}) {
    const Estimate e =
        reference_irradiance(world, {&point, 1}, 1 << 14, 2, LightKind::all, strategy)[0];
    EXPECT_NEAR(e.mean.x / open, 0.75f, 0.02f);
  }
}

}  // namespace
}  // namespace lambent::reference_estimator_test
