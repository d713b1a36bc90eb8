// SPDX-License-Identifier: Apache-2.0
// Coats under a sky with a sun: rays of coats and samples of the sky's bright part have weights
// that sum to 1, so that together they bring the light that the reference finds.
#include <gtest/gtest.h>

#include <string>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "support/bright_skies.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::bright_sky_reference_test {
namespace {

struct Coat {
  const char* name;
  float roughness;
  float clearcoat;
};

class BrightSkyReference : public testing::TestWithParam<Coat> {};

/// A metal ball, which reflects the sky alone.
test::Stage ball(const Coat& coat) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].metallic = 1.0f;
  scene.materials[0].roughness = coat.roughness;
  scene.materials[0].clearcoat = coat.clearcoat;
  scene.materials[0].clearcoat_roughness = 0.25f;
  test::add(scene, test::sphere(1.0f, 48, 0));
  scene.environment = test::sunny_sky();
  scene.cameras.push_back(look_at({0.0f, 0.3f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.6f));
  return test::Stage(std::move(scene));
}

TEST_P(BrightSkyReference, IsReflectedWithAllOfItsLight) {
  const test::Stage stage = ball(GetParam());
  FieldSettings few;
  few.probe_count = glm::ivec3(3);
  few.rays_per_probe = 64;
  const IrradianceField field = test::make_field(stage, few, 2);
  FrameSettings frame;
  frame.width = frame.height = 48;
  frame.samples = 32;
  frame.gather_rays = 0;
  frame.glossy_rows = 1;
  frame.denoise = false;
  ReferenceSettings paths;
  paths.width = paths.height = 48;
  paths.samples = 256;
  const Camera& camera = stage.scene.cameras[0];
  const LayeredImage ours =
      Renderer(stage.world, {.field = &field}).render(camera, frame).value().image;
  const LayeredImage reference = render_reference(stage.world, camera, paths).image;
  const Metrics metrics =
      compare_images(*ours.find("glossy"), *reference.find("glossy"), {}).value();
  RecordProperty("mean_ratio", std::to_string(metrics.mean_ratio));
  // Half of the light is the sun's: a weight that is left out would bring a quarter more or less
  EXPECT_NEAR(metrics.mean_ratio, 1.0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Coats, BrightSkyReference,
                         testing::Values(Coat{"smooth", 0.1f, 0.0f}, Coat{"rough", 0.5f, 0.0f},
                                         Coat{"under_a_clearcoat", 0.4f, 1.0f}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace lambent::bright_sky_reference_test
