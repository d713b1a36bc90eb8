// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "unit/gltf_builder.h"

namespace lambent {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

const float kHalf = std::sqrt(0.5f);

void expect_near(const glm::vec3& actual, const glm::vec3& expected) {
  EXPECT_LT(glm::length(actual - expected), 1e-5f)
      << actual.x << " " << actual.y << " " << actual.z;
}

glm::vec3 place(const Instance& instance, const glm::vec3& position) {
  return glm::vec3(instance.world_from_object * glm::vec4(position, 1.0f));
}

TEST(GltfNodes, SharedMeshesBecomeInstances) {
  GltfBuilder builder;
  const int mesh = builder.show(builder.triangle());
  builder.show_node({{"mesh", mesh}, {"translation", {0, 2, 0}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->meshes, SizeIs(1));
  ASSERT_THAT(scene->instances, SizeIs(2));
  EXPECT_EQ(triangle_count(*scene), 2u);
  EXPECT_EQ(world_bounds(*scene).max, glm::vec3(1, 3, 0));
}

TEST(GltfNodes, ComposeTranslationRotationAndScaleDownTheTree) {
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  const int child = builder.append("nodes", {{"mesh", mesh}, {"scale", {2, 3, 4}}});
  // A quarter turn about z takes x to y
  builder.show_node(
      {{"children", {child}}, {"rotation", {0, 0, kHalf, kHalf}}, {"translation", {5, 0, 0}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  expect_near(place(scene->instances.at(0), {1, 0, 0}), {5, 2, 0});
  expect_near(place(scene->instances.at(0), {0, 1, 0}), {2, 0, 0});
}

TEST(GltfNodes, NegativeScaleIsKept) {
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  builder.show_node({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_LT(glm::determinant(scene->instances.at(0).world_from_object), 0.0f);
}

TEST(GltfNodes, FlattenedInstancesAreLeftOut) {
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  builder.show_node({{"mesh", mesh}, {"scale", {1, 0, 1}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->instances.empty());
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("flattened")));
}

TEST(GltfNodes, GpuInstancesStandRelativeToTheirNode) {
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  const int translations = builder.accessor<float>({0, 0, 0, 10, 0, 0}, "VEC3");
  const int rotations = builder.accessor<std::int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", true);
  const int scales = builder.accessor<float>({1, 1, 1, 2, 2, 2}, "VEC3");
  builder.show_node(
      {{"mesh", mesh},
       {"translation", {0, 1, 0}},
       {"extensions",
        {{"EXT_mesh_gpu_instancing",
          {{"attributes",
            {{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}}}}}}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->instances, SizeIs(2));
  expect_near(place(scene->instances[0], {1, 0, 0}), {1, 1, 0});
  // Half a turn about z, twice as large, ten to the right
  expect_near(place(scene->instances[1], {1, 0, 0}), {8, 1, 0});
}

TEST(GltfNodes, GpuInstancesAreCountedByCustomAttributesToo) {
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  const int ids = builder.accessor<float>({7, 8, 9}, "SCALAR");
  builder.show_node(
      {{"mesh", mesh},
       {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"_ID", ids}}}}}}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->instances, SizeIs(3));
}

TEST(GltfNodes, OnlyTheChosenSceneIsShown) {
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  for (const char* name : {"a", "b"}) {
    const int node = builder.append("nodes", {{"mesh", mesh}, {"name", name}});
    builder.append("scenes", {{"nodes", {node}}});
  }
  builder.root["scene"] = 1;
  LoadOptions options;
  EXPECT_EQ(builder.load(options)->instances.at(0).name, "b");
  options.scene = 0;
  EXPECT_EQ(builder.load(options)->instances.at(0).name, "a");
  options.scene = 2;
  EXPECT_THAT(error_of(builder.load(options)), HasSubstr("scenes[2]: does not exist"));
}

TEST(GltfNodes, CyclesAreErrors) {
  GltfBuilder builder;
  builder.append("nodes", {{"children", {1}}});
  builder.append("nodes", {{"children", {0}}});
  EXPECT_THAT(error_of(builder.load()), HasSubstr("nodes[0]: the node is part of a cycle"));
  builder.root["nodes"] = Json::parse(R"([{"children": [0]}])");
  EXPECT_THAT(error_of(builder.load()), HasSubstr("nodes[0]: the node is its own child"));
  builder.root["nodes"] = Json::parse(R"([{"children": [2]}, {"children": [2]}, {}])");
  EXPECT_THAT(error_of(builder.load()), HasSubstr("nodes[2]: the node has more than one parent"));
}

TEST(GltfNodes, AbsurdDepthIsAnError) {
  GltfBuilder builder;
  constexpr int kNodes = 5000;
  for (int i = 0; i < kNodes; ++i) builder.append("nodes", {{"children", {i + 1}}});
  builder.append("nodes", Json::object());
  EXPECT_THAT(error_of(builder.load()), HasSubstr("absurdly deep"));
}

TEST(GltfNodes, TransformsThatOverflowAreErrors) {
  GltfBuilder builder;
  builder.append("nodes", {{"children", {1}}, {"scale", {1e30, 1, 1}}});
  builder.append("nodes", {{"scale", {1e30, 1, 1}}});
  EXPECT_THAT(error_of(builder.load()), HasSubstr("nodes[1]: the transform is not finite"));
}

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
  for (const char* sky : {"1", "[1, 2]", "[1, 2, \"3\"]", "[1, 2, -3]", "[1, 2, 1e200]", "null",
                          "[1, 2, null]", "{}"}) {
    GltfBuilder builder;
    builder.show(builder.triangle());
    builder.root["scenes"][0]["extras"]["lambent_sky_radiance"] = Json::parse(sky);
    const Expected<Scene> scene = builder.load();
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(scene->environment.radiance, glm::vec3(0.0f)) << sky;
    EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("lambent_sky_radiance"))) << sky;
  }
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

TEST(GltfNodes, FlagsOfInstancesStandInTheirExtras) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.root["nodes"][0]["extras"] = {{"lambent_casts_gi", false},
                                        {"lambent_receives_gi", false},
                                        {"lambent_ignored_by_probes", true}};
  builder.show_node({{"mesh", 0}, {"extras", {{"lambent_casts_gi", "no"}}}});
  builder.show_node({{"mesh", 0}, {"extras", 3}});
  const Expected<Scene> loaded = builder.load();
  ASSERT_TRUE(loaded) << error_of(loaded);
  const Scene& scene = *loaded;
  EXPECT_FALSE(scene.instances[0].casts_gi);
  EXPECT_FALSE(scene.instances[0].receives_gi);
  EXPECT_TRUE(scene.instances[0].ignored_by_probes);
  EXPECT_TRUE(scene.instances[1].casts_gi);
  EXPECT_TRUE(scene.instances[2].receives_gi);
  EXPECT_THAT(scene.source.warnings, Contains(HasSubstr("nodes[1].extras.lambent_casts_gi")));
}

TEST(GltfNodes, ProbeVolumesStandWhereTheirNodesDo) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const float half = std::sqrt(0.5f);
  builder.show_node(
      {{"name", "nook"},
       {"translation", {1, 2, 3}},
       {"rotation", {0, half, 0, half}},
       {"scale", {2, 1, 0.5}},
       {"extras",
        {{"lambent_probe_volume", {{"size", {4, 3, 2}}, {"spacing", 0.25}, {"priority", -3}}}}}});
  builder.show_node({{"extras", {{"lambent_probe_volume", {{"probes", {3, 4, 5}}}}}}});
  const Expected<Scene> loaded = builder.load();
  ASSERT_TRUE(loaded) << error_of(loaded);
  ASSERT_EQ(loaded->volumes.size(), 2u);
  const ProbeVolume& nook = loaded->volumes[0];
  EXPECT_EQ(nook.name, "nook");
  expect_near(nook.centre, {1, 2, 3});
  expect_near(nook.size, {8, 3, 1});
  // A quarter turn about +Y takes +X to -Z
  expect_near(nook.axes[0], {0, 0, -1});
  expect_near(nook.axes[2], {1, 0, 0});
  EXPECT_EQ(nook.probe_spacing, 0.25f);
  EXPECT_EQ(nook.priority, -3);
  EXPECT_EQ(loaded->volumes[1].probe_count, glm::ivec3(3, 4, 5));
  expect_near(loaded->volumes[1].size, {1, 1, 1});
  EXPECT_TRUE(loaded->source.warnings.empty());
}

TEST(GltfNodes, ProbeVolumesThatMakeNoSenseAreLeftOut) {
  using nlohmann::json;
  for (const json& volume :
       {json(3), json{{"size", {1, 2}}}, json{{"size", {1, 2, -1}}}, json{{"size", {1, 2, "x"}}},
        json{{"spacing", 0}}, json{{"spacing", -1}}, json{{"probes", {1, 2, 2}}},
        json{{"probes", {1e9, 2, 2}}}, json{{"probes", {2.5, 2, 2}}},
        json{{"probes", {2, 2, 2}}, {"spacing", 1}}, json{{"priority", 0.5}},
        json{{"priority", 1e300}}, json{{"turn", 30}}}) {
    GltfBuilder builder;
    builder.show(builder.triangle());
    builder.show_node({{"extras", {{"lambent_probe_volume", volume}}}});
    const Expected<Scene> loaded = builder.load();
    ASSERT_TRUE(loaded) << error_of(loaded);
    EXPECT_TRUE(loaded->volumes.empty()) << volume;
    EXPECT_THAT(loaded->source.warnings,
                Contains(HasSubstr("nodes[1].extras.lambent_probe_volume")));
  }
  // Neither does one in a node that is sheared or flat
  for (const json& matrix : {json{1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                             json{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}) {
    GltfBuilder builder;
    builder.show(builder.triangle());
    builder.show_node({{"matrix", matrix}, {"extras", {{"lambent_probe_volume", json::object()}}}});
    const Expected<Scene> loaded = builder.load();
    ASSERT_TRUE(loaded) << error_of(loaded);
    EXPECT_TRUE(loaded->volumes.empty());
    EXPECT_EQ(loaded->source.warnings.size(), 1u);
  }
}

}  // namespace
}  // namespace lambent
