// SPDX-License-Identifier: Apache-2.0
// What glossy things behind clear panes reflect, and what the panes reflect of it, against our own
// reference.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "support/bright_skies.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::coats_behind_glass_test {
namespace {

enum class Source { point, lamp, sky };

struct Shown {
  const char* name;
  Source source;
  bool clearcoat;  // black under a clearcoat, in place of a black polished dielectric
  int panes;
  double error;  // bound of the RMSE of 4x4 blocks over the mean
};

Material black(bool clearcoat) {
  Material ball;
  ball.base_color = {0.0f, 0.0f, 0.0f, 1.0f};
  ball.metallic = 0.0f;
  ball.roughness = clearcoat ? 1.0f : 0.3f;
  ball.clearcoat = clearcoat ? 1.0f : 0.0f;
  ball.clearcoat_roughness = 0.3f;
  return ball;
}

Material clear() {
  Material glass;
  glass.metallic = 0.0f;
  glass.roughness = 0.0f;
  glass.transmission = 1.0f;
  return glass;
}

Scene scene_of(const Shown& shown) {
  Scene scene;
  scene.materials = {black(shown.clearcoat), clear(),
                     test::lambert(glm::vec3(0.0f), glm::vec3(100.0f))};
  test::add(scene, test::sphere(0.8f, 32, 0));
  const glm::vec3 x(8.0f, 0.0f, 0.0f), y(0.0f, 8.0f, 0.0f);
  for (int i = 0; i < shown.panes; ++i) {
    test::add(scene, test::quad({-4.0f, -4.0f, 1.6f + 0.3f * static_cast<float>(i)}, x, y, 1));
  }
  if (shown.source == Source::point) {
    // Before the panes: the reference cannot find the mirror image of such a light in smooth glass
    scene.lights.push_back(test::point_light(glm::vec3(30.0f), {1.8f, 2.2f, 2.6f}));
  } else if (shown.source == Source::lamp) {
    // Shines down, and has a black back
    test::add(scene, test::quad({-0.6f, 1.5f, 0.2f}, {1.2f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.2f}, 2));
  } else {
    scene.environment = test::checkered_sky();
  }
  scene.cameras.push_back(look_at({0.0f, 0.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.5f));
  return scene;
}

class CoatsBehindGlass : public testing::TestWithParam<Shown> {};

TEST_P(CoatsBehindGlass, ReflectWhatTheyReflectWithoutIt) {
  const test::Stage stage(scene_of(GetParam()));
  const IrradianceField field = test::field_of_ball(stage);
  IndirectSources sources;
  sources.field = &field;
  FrameSettings frame;
  frame.width = frame.height = 32;
  frame.gather_rays = 0;
  frame.samples = 64;
  ReferenceSettings paths;
  paths.width = paths.height = 32;
  paths.samples = 512;
  const Camera& camera = stage.scene.cameras[0];
  const LayeredImage reference = render_reference(stage.world, camera, paths).image;
  const LayeredImage ours = Renderer(stage.world, sources).render(camera, frame).value().image;
  MetricsOptions blocks;
  blocks.block = 4;
  const Metrics found =
      compare_images(*ours.find("transmission"), *reference.find("transmission"), blocks).value();
  RecordProperty("mean_ratio", std::to_string(found.mean_ratio));
  RecordProperty("relative_rmse", std::to_string(found.relative_rmse));
  EXPECT_NEAR(found.mean_ratio, 1.0, 0.03);
  EXPECT_LT(found.relative_rmse, GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    Glass, CoatsBehindGlass,
    testing::Values(Shown{"point_on_a_dielectric", Source::point, false, 1, 0.1},
                    Shown{"point_on_a_clearcoat", Source::point, true, 1, 0.1},
                    Shown{"point_behind_two_panes", Source::point, false, 2, 0.1},
                    Shown{"lamp_on_a_dielectric", Source::lamp, false, 1, 0.25},
                    Shown{"lamp_on_a_clearcoat", Source::lamp, true, 1, 0.25},
                    Shown{"sky_in_a_clearcoat", Source::sky, true, 1, 0.03}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace lambent::coats_behind_glass_test
