// SPDX-License-Identifier: Apache-2.0
// Fog against our own reference: a shaft of sun through a hole in a room's roof.
#include <gtest/gtest.h>

#include <cmath>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "support/field_scenes.h"

namespace lambent::fog_reference_test {
namespace {

// Of the layer of fog, whose light is scattered once in frames and any number of times in the
// reference.
constexpr double kMeanTolerance = 0.03;
constexpr double kRmseTolerance = 0.10;
constexpr int kBlock = 8;

/// A grey room with a hole in its roof, the sun above, and thin fog.
Scene room_with_shaft(float density, float anisotropy, float scale_height) {
  Scene scene;
  const int grey = scenes::add_lambert(scene, "grey", glm::vec3(0.5f));
  scenes::MeshBuilder builder;
  builder.box({-3.1f, -0.1f, -3.1f}, {3.1f, 0.0f, 3.1f});
  builder.box({-3.1f, 0.0f, -3.1f}, {-3.0f, 4.0f, 3.1f});
  builder.box({3.0f, 0.0f, -3.1f}, {3.1f, 4.0f, 3.1f});
  builder.box({-3.0f, 0.0f, -3.1f}, {3.0f, 4.0f, -3.0f});
  builder.box({-3.0f, 0.0f, 3.0f}, {3.0f, 4.0f, 3.1f});
  // The roof around the hole
  builder.box({-3.1f, 4.0f, -3.1f}, {-0.7f, 4.1f, 3.1f});
  builder.box({0.7f, 4.0f, -3.1f}, {3.1f, 4.1f, 3.1f});
  builder.box({-0.7f, 4.0f, -3.1f}, {0.7f, 4.1f, -0.7f});
  builder.box({-0.7f, 4.0f, 0.7f}, {0.7f, 4.1f, 3.1f});
  scenes::add_object(scene, builder.take("room", grey));
  Light sun;
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::normalize(glm::vec3(0.25f, -1.0f, -0.2f));
  sun.intensity = glm::vec3(10.0f);
  scene.lights = {sun};
  scene.environment.radiance = glm::vec3(0.3f);
  FogVolume fog;
  fog.centre = {0.0f, 2.0f, 0.0f};
  fog.size = {6.2f, 4.2f, 6.2f};
  fog.density = density;
  fog.anisotropy = anisotropy;
  fog.scale_height = scale_height;
  scene.fog = {fog};
  scenes::add_camera(scene, "camera", {-2.4f, 1.4f, 2.6f}, {0.4f, 1.8f, -1.0f}, 1.0f, 16.0f / 9.0f);
  return scene;
}

struct Kind {
  float density, anisotropy, scale_height;
};

class FogShaft : public testing::TestWithParam<Kind> {};

TEST_P(FogShaft, IsThatOfTheReference) {
  const Kind& kind = GetParam();
  const test::Stage stage(room_with_shaft(kind.density, kind.anisotropy, kind.scale_height));
  const IrradianceField field = test::make_field(stage, {}, 4);
  FrameSettings settings;
  settings.width = 96;
  settings.height = 56;
  // As many columns as a picture of 768 x 448 has by default
  settings.fog.froxel_pixels = 1;
  const Camera& camera = stage.scene.cameras[0];
  const RenderedFrame frame =
      Renderer(stage.world, {.field = &field}).render(camera, settings).value();
  ReferenceSettings truth;
  truth.width = settings.width;
  truth.height = settings.height;
  // By these the means differ from those by half as many by 0.7 %: noise is a quarter of the
  // tolerance
  truth.samples = 128;
  const ReferenceResult reference = render_reference(stage.world, camera, truth);
  const Expected<Metrics> metrics =
      compare_images(*frame.image.find("fog"), *reference.image.find("fog"),
                     {.block = kBlock, .perceptual = false});
  ASSERT_TRUE(metrics);
  RecordProperty("ratio", std::to_string(metrics->mean_ratio));
  std::printf("fog: mean ratio %.4f, relative RMSE of 8x8 blocks %.4f\n", metrics->mean_ratio,
              metrics->relative_rmse);
  EXPECT_NEAR(metrics->mean_ratio, 1.0, kMeanTolerance);
  EXPECT_LT(metrics->relative_rmse, kRmseTolerance);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FogShaft,
                         testing::Values(Kind{0.01f, 0.0f, 0.0f}, Kind{0.02f, 0.0f, 0.0f},
                                         Kind{0.03f, 0.2f, 1.0f}));

}  // namespace
}  // namespace lambent::fog_reference_test
