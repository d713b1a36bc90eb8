// SPDX-License-Identifier: Apache-2.0
// Coats under a sky with a sun: rays of coats and samples of the sky's bright part have weights
// that sum to 1, so that together they bring the light that the reference finds.
#include <gtest/gtest.h>

#include <string>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "support/bright_skies.h"

namespace lambent::bright_sky_reference_test {
namespace {

struct Coat {
  const char* name;
  float roughness;
  float clearcoat;
};

class BrightSkyReference : public testing::TestWithParam<Coat> {};

TEST_P(BrightSkyReference, IsReflectedWithAllOfItsLight) {
  const test::Stage stage = test::ball_under_the_sun(GetParam().roughness, GetParam().clearcoat);
  const IrradianceField field = test::field_of_ball(stage);
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
