// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/limits.h"
#include "unit/gltf_checks.h"

namespace lambent::gltf_lights_cameras_test {
namespace {

using test::error_of;
using test::expect_near;
using test::GltfBuilder;
using test::Json;
using test::kHalf;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

// One light, turned so that its -z points along +x, and moved.
Expected<Scene> with_light(const Json& light) {
  GltfBuilder builder;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
  builder.show_node({{"name", "node"},
                     {"translation", {1, 2, 3}},
                     {"rotation", {0, -kHalf, 0, kHalf}},
                     {"scale", {5, 5, 5}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return builder.load();
}

TEST(GltfLights, TravelAlongTheirNodesNegativeZ) {
  const Expected<Scene> scene =
      with_light({{"type", "directional"}, {"color", {1, 0.5, 0.25}}, {"intensity", 4}});
  ASSERT_TRUE(scene) << error_of(scene);
  const Light& light = scene->lights.at(0);
  EXPECT_EQ(light.type, Light::Type::directional);
  EXPECT_EQ(light.name, "node");
  EXPECT_EQ(light.intensity, glm::vec3(4, 2, 1));
  expect_near(light.direction_ws, {1, 0, 0});
}

TEST(GltfLights, SpotsHaveCones) {
  const Expected<Scene> scene = with_light(Json::parse(R"({"type": "spot", "range": 7,
      "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}})"));
  ASSERT_TRUE(scene) << error_of(scene);
  const Light& light = scene->lights.at(0);
  EXPECT_EQ(light.type, Light::Type::spot);
  expect_near(light.position_ws, {1, 2, 3});
  EXPECT_EQ(light.range, 7.0f);
  EXPECT_EQ(light.inner_cone_angle, 0.25f);
  EXPECT_EQ(light.outer_cone_angle, 0.5f);
}

TEST(GltfLights, NumbersOutOfRangeAreBroughtIntoIt) {
  const Expected<Scene> scene = with_light(Json::parse(R"({"type": "spot", "range": 0,
      "intensity": -3, "spot": {"outerConeAngle": 4}})"));
  ASSERT_TRUE(scene) << error_of(scene);
  const Light& light = scene->lights.at(0);
  EXPECT_EQ(light.range, 0.0f);  // infinite
  EXPECT_EQ(light.intensity, glm::vec3(0.0f));
  expect_near(glm::vec3(light.outer_cone_angle), glm::vec3(1.5707963f));
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("3 numbers out of the range of glTF")));
}

TEST(GltfLights, UnknownTypesAreErrors) {
  EXPECT_THAT(error_of(with_light({{"type", "area"}})),
              HasSubstr("extensions.KHR_lights_punctual.lights[0].type"));
}

TEST(GltfCameras, LoseScaleAndMirroring) {
  GltfBuilder builder;
  builder.append("cameras", Json::parse(R"({"type": "perspective", "name": "c",
      "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 1.5}})"));
  builder.show_node({{"camera", 0}, {"translation", {1, 2, 3}}, {"scale", {-3, 2, 5}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Camera& camera = scene->cameras.at(0);
  EXPECT_EQ(camera.name, "c");
  EXPECT_EQ(camera.vertical_fov, 0.5f);
  EXPECT_EQ(camera.aspect, 1.5f);
  glm::mat4 expected(1.0f);
  expected[3] = glm::vec4(1, 2, 3, 1);
  EXPECT_EQ(camera.world_from_view, expected);
}

TEST(GltfCameras, OrthographicOnesHaveAnExtent) {
  GltfBuilder builder;
  builder.append("cameras", Json::parse(R"({"type": "orthographic",
      "orthographic": {"xmag": 3, "ymag": 1.5, "znear": 0.1, "zfar": 9}})"));
  builder.show_node({{"camera", 0}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->cameras.at(0).orthographic);
  EXPECT_EQ(scene->cameras[0].vertical_extent, 3.0f);
  EXPECT_EQ(scene->cameras[0].aspect, 2.0f);
}

TEST(GltfCameras, OrthographicOnesWithoutAShapeAreErrors) {
  for (const auto& [xmag, ymag] : {std::pair{0.0, 1.0}, {1.0, 0.0}, {1e38, 1e-38}}) {
    GltfBuilder builder;
    builder.append("cameras",
                   {{"type", "orthographic"},
                    {"orthographic", {{"xmag", xmag}, {"ymag", ymag}, {"znear", 0}, {"zfar", 9}}}});
    builder.show_node({{"camera", 0}});
    EXPECT_THAT(error_of(builder.load()), HasSubstr("cameras[0]")) << xmag << " " << ymag;
  }
}

TEST(GltfSky, IsReadFromTheExtrasOfTheChosenScene) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.root["scenes"][0]["extras"]["lambent_sky_radiance"] = {0.25, 0.5, 2};
  builder.append("scenes", {{"nodes", {0}}, {"extras", "of somebody else's"}});
  const Expected<Scene> first = builder.load();
  ASSERT_TRUE(first) << error_of(first);
  EXPECT_EQ(first->environment.radiance, glm::vec3(0.25f, 0.5f, 2.0f));
  EXPECT_THAT(first->source.warnings, SizeIs(0));

  LoadOptions options;
  options.scene = 1;
  const Expected<Scene> second = builder.load(options);
  ASSERT_TRUE(second) << error_of(second);
  EXPECT_EQ(second->environment.radiance, glm::vec3(0.0f));
}

TEST(GltfSky, WhatIsNoRadianceStaysBlackAndIsTold) {
  for (const char* sky : {"1", "[1, 2]", "[1, 2, \"3\"]", "[1, 2, -3]", "[1, 2, 1e200]",
                          "[1, 2, 1e11]", "null", "[1, 2, null]", "{}"}) {
    GltfBuilder builder;
    builder.show(builder.triangle());
    builder.root["scenes"][0]["extras"]["lambent_sky_radiance"] = Json::parse(sky);
    const Expected<Scene> scene = builder.load();
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->environment.radiance, glm::vec3(0.0f)) << sky;
    EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("lambent_sky_radiance"))) << sky;
  }
}

TEST(GltfLights, TooBrightOnesAreReducedAndKeepTheirHue) {
  for (const char* type : {"point", "directional"}) {
    GltfBuilder builder;
    builder.show(builder.triangle());
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", type}, {"intensity", 1e30}, {"color", {1, 0.5, 0}}}});
    builder.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    const Expected<Scene> scene = builder.load();
    ASSERT_TRUE(scene) << error_of(scene);
    const glm::vec3 intensity = scene->lights.at(0).intensity;
    EXPECT_EQ(intensity.r, type[0] == 'p' ? kMaxIntensity : kMaxIrradiance);
    EXPECT_EQ(intensity.g, 0.5f * intensity.r);
    EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("reduced to 1e1")));
  }
}

TEST(GltfLights, AndCamerasOutOfReachNameTheirNode) {
  GltfBuilder builder;
  builder.append("cameras",
                 {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  builder.show_node({{"camera", 0}, {"translation", {1e19, 0, 0}}});
  EXPECT_THAT(error_of(builder.load()), HasSubstr("nodes[0]: the camera is beyond 1e9 m"));
  builder.root["nodes"][0].erase("camera");
  builder.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "point"}}});
  EXPECT_THAT(error_of(builder.load()), HasSubstr("nodes[0]: the light is beyond 1e9 m"));
}

TEST(GltfCameras, FieldsOfViewInDegreesAreRepaired) {
  GltfBuilder builder;
  builder.append("cameras",
                 {{"type", "perspective"}, {"perspective", {{"yfov", 60}, {"znear", 1}}}});
  builder.show_node({{"camera", 0}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_FLOAT_EQ(scene->cameras.at(0).vertical_fov, glm::radians(60.0f));
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("degrees")));
  builder.root["cameras"][0]["perspective"]["yfov"] = 180;
  EXPECT_THAT(error_of(builder.load()), HasSubstr("yfov: is 180"));
}

TEST(GltfCameras, ShapesOutOfRangeAreRefusedOrIgnored) {
  GltfBuilder builder;
  builder.append("cameras",
                 {{"type", "perspective"}, {"perspective", {{"yfov", 1e-20}, {"znear", 1}}}});
  builder.show_node({{"camera", 0}});
  EXPECT_THAT(error_of(builder.load()),
              HasSubstr("yfov: is 1e-20, which is not within 0.001 to 179.9"));
  builder.root["cameras"][0]["perspective"] = {{"yfov", 1}, {"znear", 1}, {"aspectRatio", 1e30}};
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(scene->cameras.at(0).aspect, 0.0f);
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("aspect ratios")));
  builder.root["cameras"][0] = {
      {"type", "orthographic"},
      {"orthographic", {{"xmag", 1e12}, {"ymag", 1e12}, {"znear", 0}, {"zfar", 1}}}};
  EXPECT_THAT(error_of(builder.load()), HasSubstr("cameras[0].orthographic.ymag: is not within"));
}

TEST(LookAt, LooksAtItsTargetWithPositiveYUp) {
  const Camera camera = look_at({1, 2, 3}, {1, 2, -7}, 1.0f);
  expect_near(-glm::vec3(camera.world_from_view[2]), {0, 0, -1});
  expect_near(glm::vec3(camera.world_from_view[1]), {0, 1, 0});
  expect_near(glm::vec3(camera.world_from_view[0]), {1, 0, 0});
  expect_near(glm::vec3(camera.world_from_view[3]), {1, 2, 3});
}

TEST(LookAt, StraightDownHasAFrameToo) {
  const Camera camera = look_at({0, 5, 0}, {0, 0, 0}, 1.0f);
  expect_near(-glm::vec3(camera.world_from_view[2]), {0, -1, 0});
  EXPECT_NEAR(glm::determinant(glm::mat3(camera.world_from_view)), 1.0f, 1e-5f);
}

}  // namespace
}  // namespace lambent::gltf_lights_cameras_test
