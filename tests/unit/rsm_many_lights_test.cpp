// SPDX-License-Identifier: Apache-2.0
// Maps of many lights in one picture.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lambent/rsm.h"
#include "lambent/world.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "rsm/maps/lights.h"
#include "support/field_scenes.h"
#include "support/lit_box.h"
#include "support/made_view.h"

namespace lambent::rsm_many_lights_test {
namespace {

using test::Stage;

constexpr int kWidth = 48, kHeight = 36;
constexpr float kAspect = static_cast<float>(kWidth) / static_cast<float>(kHeight);

/// What the camera of a stage sees.
test::MadeView view_of(const Stage& stage) {
  const Camera& camera = stage.scene.cameras.front();
  test::MadeView view(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Ray ray = camera_ray(camera, kWidth, kHeight, static_cast<float>(x) + 0.5f,
                                 static_cast<float>(y) + 0.5f);
      const Hit hit = tracer_of(stage.world).closest_hit(ray);
      if (hit.missed()) {
        view.add(vec3(0.0f), vec3(0.0f), 0.0f);
        continue;
      }
      const Surface surface = surface_at(stage.scene, ray, hit);
      view.add(surface.position_ws, surface.normal_ws, view_depth(camera, surface.position_ws));
    }
  }
  return view;
}

RsmSettings small_maps() {
  RsmSettings settings;
  settings.resolution = 64;
  settings.texels = 256;
  return settings;
}

std::vector<vec3> light_of(const Stage& stage, const test::MadeView& view,
                           const RsmSettings& settings) {
  RsmIrradiance light;
  EXPECT_TRUE(RsmGatherer().gather(stage.world, stage.scene.cameras.front(), kAspect, view.view(),
                                   settings, light));
  return light.irradiance;
}

/// Root mean square of the difference over the mean, both of all channels.
double error(const std::vector<vec3>& light, const std::vector<vec3>& truth) {
  double squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const vec3 difference = light[i] - truth[i];
    squares += dot(difference, difference);
    sum += truth[i].x + truth[i].y + truth[i].z;
  }
  const double count = 3.0 * static_cast<double>(truth.size());
  return std::sqrt(squares / count) / (sum / count);
}

double mean(const std::vector<vec3>& light) {
  double sum = 0.0;
  for (const vec3& e : light) sum += e.x + e.y + e.z;
  return sum / (3.0 * static_cast<double>(light.size()));
}

/// The pictures of each light alone, added up.
std::vector<vec3> sum_of_lights(const Scene& scene, const test::MadeView& view,
                                const RsmSettings& settings) {
  std::vector<vec3> sum(view.positions.size(), vec3(0.0f));
  for (const Light& light : scene.lights) {
    Scene alone = scene;
    alone.lights = {light};
    const Stage stage(std::move(alone));
    const std::vector<vec3> added = light_of(stage, view, settings);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += added[i];
  }
  return sum;
}

// Without sub-maps and blurs each pixel gathers all that was chosen of each map.
TEST(RsmOfManyLights, IsTheSumOfEachLightsOwn) {
  for (const int lights : {2, 8, 64}) {
    const Stage stage(test::lit_box("cornell-spot", lights));
    const test::MadeView view = view_of(stage);
    RsmSettings settings = plain_gather();
    settings.resolution = 32;
    settings.texels = 64;
    const std::vector<vec3> sum = sum_of_lights(stage.scene, view, settings);
    EXPECT_LT(error(light_of(stage, view, settings), sum), 1e-5) << lights;
  }
}

TEST(RsmOfManyLights, IsTheSumOfEachLightsOwnInAllPatternsAndLayouts) {
  const Stage stage(test::lit_box("cornell-spot", 8));
  const test::MadeView view = view_of(stage);
  for (const RsmPattern pattern : {RsmPattern::whole, RsmPattern::disk}) {
    for (const RsmLayout layout : {RsmLayout::restructured, RsmLayout::sub_maps, RsmLayout::full}) {
      RsmSettings settings = small_maps();
      settings.pattern = pattern;
      settings.layout = layout;
      const std::vector<vec3> sum = sum_of_lights(stage.scene, view, settings);
      // The same clusters are dealt to other sub-maps: blurs leave some of that
      const std::vector<vec3> light = light_of(stage, view, settings);
      const std::string of = std::to_string(static_cast<int>(pattern)) + ", " +
                             std::to_string(static_cast<int>(layout));
      EXPECT_LT(error(light, sum), 0.1) << of;
      EXPECT_NEAR(mean(light) / mean(sum), 1.0, 0.01) << of;
    }
  }
}

TEST(RsmOfManyLights, IsTheSameFromMapsMadeOneAfterTheOther) {
  const Stage stage(test::lit_box("cornell-spot", 8));
  const test::MadeView view = view_of(stage);
  for (const bool merge : {false, true}) {
    for (const RsmLayout layout : {RsmLayout::restructured, RsmLayout::full}) {
      RsmSettings settings = small_maps();
      settings.layout = layout;
      settings.merge_maps = merge;
      const auto maps =
          render_rsms(stage.world, stage.scene.cameras.front(), kAspect, settings).value();
      ASSERT_EQ(maps.size(), 8u);
      RsmIrradiance light;
      ASSERT_TRUE(RsmGatherer().gather(stage.world, maps, view.view(), settings, light));
      EXPECT_EQ(light_of(stage, view, settings), light.irradiance) << merge;
    }
  }
}

TEST(RsmMergedMaps, GatherAsManyTexelsAsOneMapDoes) {
  const Stage stage(test::lit_box("cornell-spot", 64));
  const test::MadeView view = view_of(stage);
  RsmSettings settings = small_maps();
  settings.resolution = 32;
  const auto maps =
      render_rsms(stage.world, stage.scene.cameras.front(), kAspect, settings).value();
  EXPECT_EQ(choose_lights(maps, view.view(), settings).restructured.size(), 64u * 256u);
  settings.merge_maps = true;
  const RsmLights merged = choose_lights(maps, view.view(), settings);
  EXPECT_EQ(merged.restructured.size(), 256u);
  EXPECT_EQ(merged.count(0), 16u);
}

// 256 clusters for 64 lights in place of 256 for each: all light, with little more error.
TEST(RsmMergedMaps, BringTheLightOfAllLights) {
  for (const int lights : {2, 8, 64}) {
    const Stage stage(test::lit_box("cornell-spot", lights));
    const test::MadeView view = view_of(stage);
    RsmSettings settings = plain_gather();
    settings.resolution = 32;
    settings.texels = 256;
    const std::vector<vec3> each = light_of(stage, view, settings);
    settings.merge_maps = true;
    const std::vector<vec3> merged = light_of(stage, view, settings);
    EXPECT_NEAR(mean(merged) / mean(each), 1.0, 0.02) << lights;
    EXPECT_LT(error(merged, each), 0.1) << lights;
  }
}

// Sixteen times the same light: the clusters shine sixteen times as bright, but are not sixteen
// times as large.
TEST(RsmMergedMaps, DoNotTakeSurfacesForLargerThatSeveralLightsReach) {
  Scene scene = test::lit_box("cornell-spot", 2);
  scene.lights = {scene.lights[1]};
  const Stage one(scene);
  const test::MadeView view = view_of(one);
  RsmSettings settings = plain_gather();
  settings.resolution = 32;
  settings.texels = 64;
  std::vector<vec3> expected = light_of(one, view, settings);
  for (vec3& e : expected) e *= 16.0f;
  scene.lights.resize(16, scene.lights[0]);
  const Stage sixteen(scene);
  settings.merge_maps = true;
  const auto maps = render_rsms(sixteen.world, scene.cameras.front(), kAspect, settings).value();
  const RsmLights merged = choose_lights(maps, view.view(), settings);
  settings.merge_maps = false;
  const RsmLights single = choose_lights({maps.data(), 1}, view.view(), settings);
  double merged_area = 0.0, area = 0.0;
  for (const RsmTexel& texel : merged.restructured) merged_area += texel.area;
  for (const RsmTexel& texel : single.restructured) area += texel.area;
  EXPECT_GT(merged_area / area, 0.9);
  EXPECT_LT(merged_area / area, 4.0);
  settings.merge_maps = true;
  EXPECT_LT(error(light_of(sixteen, view, settings), expected), 0.12);
}

}  // namespace
}  // namespace lambent::rsm_many_lights_test
