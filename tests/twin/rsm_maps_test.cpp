// SPDX-License-Identifier: Apache-2.0
// Maps that a device makes, and what it chooses of them, beside those of the CPU.
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "lambent/world.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/world_access.h"
#include "rsm/vulkan/gather_vulkan.h"
#include "rsm/vulkan/maps_vulkan.h"
#include "scenes/builtin.h"
#include "support/seen_view.h"
#include "support/vulkan_device.h"

namespace lambent::rsm_maps_test {
namespace {

constexpr int kWidth = 61, kHeight = 43;
constexpr float kAspect = static_cast<float>(kWidth) / kHeight;

/// Cornell's box with lights of all kinds of maps.
Scene lit_box() {
  Scene scene = scenes::make("cornell-spot").value();
  Light sun;
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::normalize(glm::vec3(0.3f, -0.5f, -1.0f));
  sun.intensity = glm::vec3(2.0f, 1.8f, 1.5f);
  scene.lights.push_back(sun);
  Light bulb = scene.lights.front();
  bulb.type = Light::Type::point;
  scene.lights.push_back(bulb);
  Light wide = scene.lights.front();
  wide.outer_cone_angle = 0.45f * std::numbers::pi_v<float>;
  scene.lights.push_back(wide);
  return scene;
}

/// A scene on the host and on the device.
struct TwinStage {
  TwinStage(Scene made, std::shared_ptr<vulkan::Device> device)
      : scene(std::move(made)), host(scene), world(scene, std::move(device)) {}
  const Camera& camera() const { return scene.cameras[0]; }
  const Scene scene;
  const World host, world;
};

RsmSettings small_maps(int resolution) {
  RsmSettings settings;
  settings.resolution = resolution;
  settings.texels = 200;
  return settings;
}

// Positions are found by different ray tracers, whose distances differ in the last places.
constexpr float kTexelDifference = 2e-4f;

bool alike(const RsmTexel& a, const RsmTexel& b) {
  const auto near = [](float x, float y) {
    return std::abs(x - y) <= kTexelDifference * (std::abs(x) + 1e-6f);
  };
  return length(a.position_ws - b.position_ws) <=
             kTexelDifference * (1.0f + length(a.position_ws)) &&
         length(a.normal_ws - b.normal_ws) <= kTexelDifference && near(a.area, b.area) &&
         near(a.flux.x, b.flux.x) && near(a.flux.y, b.flux.y) && near(a.flux.z, b.flux.z);
}

class RsmMapsTwin : public test::OnDevice {
 protected:
  /// Makes both, and says what share of texels differ: those at edges may see what is beside.
  double share_of_others(const TwinStage& stage, const RsmSettings& settings) {
    const auto expected = render_rsms(stage.host, stage.camera(), kAspect, settings).value();
    RsmMapsOnDevice made;
    device().kept<RsmMapperVulkan>().render(stage.world, stage.camera(), kAspect, settings, made);
    const auto maps = download_maps(device(), made);
    EXPECT_EQ(maps.size(), expected.size());
    std::size_t others = 0, texels = 0, lit = 0;
    for (std::size_t m = 0; m < maps.size(); ++m) {
      EXPECT_EQ(maps[m].projection.kind, expected[m].projection.kind);
      for (std::size_t i = 0; i < maps[m].texels.size(); ++i, ++texels) {
        if (!alike(expected[m].texels[i], maps[m].texels[i])) ++others;
        if (maps[m].texels[i].flux != vec3(0.0f)) ++lit;
      }
    }
    EXPECT_GT(lit, texels / 8);
    return static_cast<double>(others) / static_cast<double>(texels);
  }
};

TEST_F(RsmMapsTwin, SeeTheSameFromLightsOfAllKinds) {
  const TwinStage stage(lit_box(), shared_device());
  EXPECT_LT(share_of_others(stage, small_maps(33)), 0.005);
}

TEST_F(RsmMapsTwin, SeeTheSameFromTheCamera) {
  const TwinStage stage(scenes::make("cornell").value(), shared_device());
  RsmSettings settings = small_maps(33);
  settings.from_camera = true;
  EXPECT_LT(share_of_others(stage, settings), 0.02);
}

TEST_F(RsmMapsTwin, LeaveOutWhatCastsNoIndirectLight) {
  Scene scene = lit_box();
  for (std::size_t i = 0; i < scene.instances.size(); i += 2) scene.instances[i].casts_gi = false;
  const TwinStage stage(std::move(scene), shared_device());
  EXPECT_LT(share_of_others(stage, small_maps(20)), 0.01);
}

/// Relative RMSE of a picture's luminance, roughly.
double relative_rmse(const std::vector<vec3>& expected, const std::vector<vec3>& light) {
  double error = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    error += std::pow(length(expected[i] - light[i]), 2.0);
    sum += length(expected[i]);
  }
  const double count = static_cast<double>(expected.size());
  return std::sqrt(error / count) / (sum / count);
}

/// What the camera sees, on both sides.
struct TwinView {
  TwinView(const TwinStage& stage, const vulkan::Device& device)
      : seen(test::seen_view(stage.host, stage.camera(), kWidth, kHeight)),
        positions(vulkan::upload(device, seen.positions, "positions")),
        normals(vulkan::upload(device, seen.normals, "normals")),
        depths(vulkan::upload(device, seen.depths, "depths")),
        on_device{
            kWidth, kHeight, {{positions.address()}, {normals.address()}, {depths.address()}}} {}
  test::MadeView seen;
  vulkan::Buffer positions, normals, depths;
  RsmViewOnDevice on_device;
};

/// Light of the device's maps, chosen and gathered there.
std::vector<vec3> light_on_device(const TwinStage& stage, const TwinView& view,
                                  const RsmSettings& settings, RsmMapsOnDevice& maps) {
  const DeviceWorld& world = *device_world_of(stage.world);
  auto& mapper = world.device().kept<RsmMapperVulkan>();
  auto& gatherer = world.device().kept<RsmGathererVulkan>();
  mapper.render(stage.world, stage.camera(), kAspect, settings, maps);
  RsmIrradiance result;
  gatherer.light(mapper, maps, view.on_device, settings, world, result);
  std::vector<vec3> light(static_cast<std::size_t>(kWidth) * kHeight);
  vulkan::read(world.device(), gatherer.irradiance(), std::span(light));
  return light;
}

std::vector<vec3> light_on_host(const TwinStage& stage, const TwinView& view,
                                std::span<const ReflectiveShadowMap> maps,
                                const RsmSettings& settings) {
  RsmIrradiance result;
  EXPECT_TRUE(RsmGatherer().gather(stage.host, maps, view.seen.view(), settings, result));
  return result.irradiance;
}

TEST_F(RsmMapsTwin, LightTheViewAlikeWithoutLeavingTheDevice) {
  const TwinStage stage(lit_box(), shared_device());
  const TwinView view(stage, device());
  RsmSettings disk = small_maps(48), all = small_maps(24), camera = small_maps(24);
  disk.pattern = RsmPattern::disk;
  all.texels = 0;
  camera.from_camera = true;
  camera.texels = 0;
  for (const RsmSettings& settings : {disk, all, camera}) {
    RsmMapsOnDevice maps;
    const std::vector<vec3> light = light_on_device(stage, view, settings, maps);
    const auto expected = light_on_host(
        stage, view, render_rsms(stage.host, stage.camera(), kAspect, settings).value(), settings);
    EXPECT_LT(relative_rmse(expected, light), 0.01);
  }
}

// Where clusters are split hangs on the last places of what they weigh, so that others may be
// chosen: from maps of two ray tracers the CPU itself chooses clusters whose light differs by some
// percent. They must come as near to the light of all texels.
TEST_F(RsmMapsTwin, ChooseTexelsThatAreAsGood) {
  const TwinStage stage(lit_box(), shared_device());
  const TwinView view(stage, device());
  RsmSettings full = small_maps(64), merged = small_maps(64);
  full.layout = RsmLayout::full;
  merged.merge_maps = true;
  for (const RsmSettings& settings : {small_maps(64), full, merged}) {
    RsmMapsOnDevice maps;
    const std::vector<vec3> light = light_on_device(stage, view, settings, maps);
    const std::vector<ReflectiveShadowMap> same = download_maps(device(), maps);
    const std::vector<vec3> expected = light_on_host(stage, view, same, settings);
    RsmSettings exhaustive = settings;
    exhaustive.texels = 0;
    exhaustive.merge_maps = false;
    const std::vector<vec3> truth = light_on_host(stage, view, same, exhaustive);
    const double error = relative_rmse(truth, expected);
    EXPECT_LT(relative_rmse(expected, light), error);
    EXPECT_LT(relative_rmse(truth, light), 1.25 * error);
  }
}

TEST_F(RsmMapsTwin, ChooseAllLightFromTheSamePointsOfView) {
  const TwinStage stage(lit_box(), shared_device());
  const TwinView view(stage, device());
  const RsmSettings settings = small_maps(45);
  auto& mapper = device().kept<RsmMapperVulkan>();
  RsmMapsOnDevice maps;
  mapper.render(stage.world, stage.camera(), kAspect, settings, maps);
  const RsmLights lights = mapper.choose(maps, view.on_device, settings);
  const RsmLights expected =
      choose_lights(download_maps(device(), maps), view.seen.view(), settings);
  ASSERT_EQ(lights.restructured.size(), expected.restructured.size());
  EXPECT_EQ(lights.starts, expected.starts);
  vec3 sum(0.0f), expected_sum(0.0f);
  for (std::size_t i = 0; i < lights.restructured.size(); ++i) {
    sum += lights.restructured[i].flux;
    expected_sum += expected.restructured[i].flux;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected_sum[c], 0.01f * expected_sum[c]);
}

// Memory for one map serves all lights, and the clusters are the same.
TEST_F(RsmMapsTwin, ChooseTheSameOfMapsMadeOneAfterTheOther) {
  const TwinStage stage(lit_box(), shared_device());
  const TwinView view(stage, device());
  auto& mapper = device().kept<RsmMapperVulkan>();
  for (const bool merge : {false, true}) {
    RsmSettings settings = small_maps(45);
    settings.merge_maps = merge;
    RsmMapsOnDevice all, one;
    mapper.render(stage.world, stage.camera(), kAspect, settings, all);
    const RsmLights expected = mapper.choose(all, view.on_device, settings);
    EXPECT_EQ(expected.restructured.size(), merge ? 208u : 4u * 208u);
    mapper.prepare(stage.world, stage.camera(), kAspect, settings, one);
    ASSERT_TRUE(one.one_at_a_time);
    EXPECT_LT(one.texels.bytes(), all.texels.bytes());
    double map_ms = 0.0;
    const RsmLights lights =
        mapper.choose(one, view.on_device, settings, device_world_of(stage.world), &map_ms);
    EXPECT_EQ(lights.places, expected.places);
    ASSERT_EQ(lights.restructured.size(), expected.restructured.size());
    for (std::size_t k = 0; k < lights.restructured.size(); ++k) {
      EXPECT_EQ(lights.restructured[k].flux, expected.restructured[k].flux);
    }
  }
}

}  // namespace
}  // namespace lambent::rsm_maps_test
