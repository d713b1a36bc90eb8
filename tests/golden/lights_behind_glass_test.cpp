// SPDX-License-Identifier: Apache-2.0
// Lights behind rough glass: rays through it and samples of the lights have weights that sum to 1,
// so that together they bring the light that the reference finds, with less noise than rays alone.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "core/image/metrics.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "scene/latitude_longitude.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::lights_behind_glass_test {
namespace {

enum class Source { lamp, sun, point };

struct Glass {
  const char* name;
  Source source;
  bool ball;     // a ball in place of two panes
  double noise;  // bound of the relative RMSE of 8 samples
};

Material frosted(float roughness, bool bounds_volume) {
  Material glass;
  glass.metallic = 0.0f;
  glass.roughness = roughness;
  glass.transmission = 1.0f;
  glass.base_color = {0.9f, 1.0f, 0.8f, 1.0f};
  glass.bounds_volume = bounds_volume;
  glass.absorption = glm::vec3(bounds_volume ? 0.1f : 0.0f);
  return glass;
}

void add_source(Source source, Scene& scene) {
  const glm::vec3 place(0.3f, 0.2f, -2.0f);
  if (source == Source::point) {
    scene.lights.push_back(test::point_light(glm::vec3(1.0f), place));
    return;
  }
  if (source == Source::lamp) {
    scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(400.0f, 300.0f, 200.0f)));
    test::add(scene, test::quad(place, {0.05f, 0.0f, 0.0f}, {0.0f, 0.05f, 0.0f}, 2));
    return;
  }
  scene.environment.radiance = glm::vec3(1.0f);
  scene.environment.map = Image(128, 64, 3);
  for (float& value : scene.environment.map.pixels) value = 0.02f;
  const glm::vec2 uv = latitude_longitude_from_direction(glm::normalize(place), 0.0f);
  for (int k = 0; k < 3; ++k) {
    scene.environment.map.at(static_cast<int>(uv.x * 128.0f), static_cast<int>(uv.y * 64.0f))[k] =
        300.0f;
  }
}

Scene scene_of(const Glass& glass) {
  Scene scene;
  scene.materials = {frosted(glass.ball ? 0.4f : 0.3f, glass.ball), frosted(0.5f, false)};
  if (glass.ball) {
    test::add(scene, test::sphere(0.8f, 32, 0));
  } else {
    const glm::vec3 x(6.0f, 0.0f, 0.0f), y(0.0f, 6.0f, 0.0f);
    test::add(scene, test::quad({-3.0f, -3.0f, 0.5f}, x, y, 0));
    test::add(scene, test::quad({-3.0f, -3.0f, -0.5f}, x, y, 1));
  }
  add_source(glass.source, scene);
  scene.cameras.push_back(look_at({0.0f, 0.0f, 2.5f}, {0.0f, 0.0f, 0.0f}, 0.7f));
  return scene;
}

class LightsBehindGlass : public testing::TestWithParam<Glass> {};

TEST_P(LightsBehindGlass, ShineThroughWithAllOfTheirLightAndLittleNoise) {
  const test::Stage stage(scene_of(GetParam()));
  FrameSettings frame;
  frame.width = frame.height = 32;
  frame.gather_rays = 0;
  frame.denoise = false;
  ReferenceSettings paths;
  paths.width = paths.height = 32;
  paths.samples = 256;
  const Camera& camera = stage.scene.cameras[0];
  const LayeredImage reference = render_reference(stage.world, camera, paths).image;
  const auto difference = [&](int samples) {
    frame.samples = samples;
    const LayeredImage ours = Renderer(stage.world).render(camera, frame).value().image;
    return compare_images(*ours.find("transmission"), *reference.find("transmission"), {}).value();
  };
  const Metrics many = difference(64), few = difference(8);
  RecordProperty("mean_ratio", std::to_string(many.mean_ratio));
  RecordProperty("relative_rmse", std::to_string(few.relative_rmse));
  // The mean of the ball has noise of 0.7 %
  EXPECT_NEAR(many.mean_ratio, 1.0, 0.02);
  EXPECT_LT(few.relative_rmse, GetParam().noise);
}

INSTANTIATE_TEST_SUITE_P(Glass, LightsBehindGlass,
                         testing::Values(Glass{"lamp_behind_panes", Source::lamp, false, 0.8},
                                         Glass{"sun_behind_panes", Source::sun, false, 0.8},
                                         Glass{"point_behind_panes", Source::point, false, 0.8},
                                         Glass{"lamp_behind_a_ball", Source::lamp, true, 2.0},
                                         Glass{"point_behind_a_ball", Source::point, true, 2.0}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace lambent::lights_behind_glass_test
