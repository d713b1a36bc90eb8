// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "unit/gltf_checks.h"

namespace lambent::gltf_nodes_test {
namespace {

using test::error_of;
using test::expect_near;
using test::GltfBuilder;
using test::Json;
using test::kHalf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

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

/// The error or the last warning of a triangle in a node with these properties.
std::string words_about(Json node) {
  GltfBuilder builder;
  node["mesh"] = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  builder.show_node(std::move(node));
  const Expected<Scene> scene = builder.load();
  if (!scene) return error_of(scene);
  return scene->source.warnings.empty() ? std::string() : scene->source.warnings.back();
}

TEST(GltfNodes, OfScenesThatRoundingIsLargeInThereIsAWarning) {
  EXPECT_EQ(words_about({{"translation", {5, 0, -20}}}), "");
  EXPECT_THAT(words_about({{"translation", {1.2e5, 0, 0}}}),
              HasSubstr("1.2e+05 m from its file's origin"));
  // As far away, but as large, too
  EXPECT_EQ(words_about({{"translation", {1.2e5, 0, 0}}, {"scale", {1e5, 1e5, 1e5}}}), "");
  EXPECT_THAT(words_about({{"scale", {1e-4, 1e-4, 1e-4}}}), HasSubstr("Scale it up."));
}

TEST(GltfNodes, FlatInstancesAreDrawnFlat) {
  // The triangle's plane, z = 0, is kept and seen from the front
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  builder.show_node({{"mesh", mesh}, {"scale", {1, 1, 0}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->source.warnings, SizeIs(0));
  ASSERT_THAT(scene->instances, SizeIs(1));
  const World world(*scene);
  const Ray ray{{0.25f, 0.25f, 1.0f}, 0.0f, {0.0f, 0.0f, -1.0f}};
  const Hit hit = tracer_of(world).closest_hit(ray);
  ASSERT_FALSE(hit.missed());
  EXPECT_NEAR(hit.distance, 1.0f, 1e-5f);
  expect_near(surface_at(*scene, ray, hit, 0.0f).normal_ws, {0, 0, 1});
}

TEST(GltfNodes, NormalsOfAFlattenedMeshStandOnItsPlane) {
  // A slope that is flattened to the ground
  GltfBuilder builder;
  const int positions = builder.accessor<float>({0, 0, 0, 0, 1, 1, 1, 0.5f, 0}, "VEC3");
  const int mesh = builder.append(
      "meshes", {{"primitives", Json::array({{{"attributes", {{"POSITION", positions}}}}})}});
  builder.show_node({{"mesh", mesh}, {"scale", {1, 0, 1}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const World world(*scene);
  const Ray ray{{0.3f, 1.0f, 0.3f}, 0.0f, {0.0f, -1.0f, 0.0f}};
  const Hit hit = tracer_of(world).closest_hit(ray);
  ASSERT_FALSE(hit.missed());
  EXPECT_NEAR(hit.distance, 1.0f, 1e-3f);
  const Surface surface = surface_at(*scene, ray, hit, 0.0f);
  EXPECT_GT(surface.normal_ws.y, 0.999f);
  EXPECT_GT(surface.geometric_normal_ws.y, 0.999f);
}

TEST(GltfNodes, WhatCannotBeDrawnIsTold) {
  EXPECT_EQ(words_about({{"scale", {1, 0, 0}}}),
            "1 instances scaled to a line or a point were left out, first in nodes[0].");
  EXPECT_THAT(words_about({{"scale", {1e-30, 1e-30, 1e-30}}}), HasSubstr("a line or a point"));
  EXPECT_THAT(words_about({{"scale", {1e20, 1e20, 1e20}}}),
              HasSubstr("nodes[0]: the mesh is scaled by more than 1e10"));
  EXPECT_THAT(words_about({{"scale", {2e9, 1, 1}}}),
              HasSubstr("nodes[0]: the mesh reaches beyond 1e9 m"));
  EXPECT_THAT(words_about({{"translation", {0, 1e19, 0}}}),
              HasSubstr("nodes[0]: the mesh reaches beyond 1e9 m"));
  EXPECT_THAT(words_about({{"translation", {0, 9e8, 0}}}), HasSubstr("less (0, 900000000, 0) m."));
}

TEST(GltfNodes, RootsThatAreChildrenStandWhereTheirParentsPutThem) {
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  builder.show_node({{"children", {1}}, {"translation", {5, 0, 0}}});
  builder.show_node({{"mesh", mesh}, {"translation", {0, 2, 0}}});
  for (const Json& roots : {Json{0, 1}, Json{1}}) {
    builder.root["scenes"][0]["nodes"] = roots;
    const Expected<Scene> scene = builder.load();
    ASSERT_TRUE(scene) << error_of(scene);
    ASSERT_THAT(scene->instances, SizeIs(1));
    expect_near(place(scene->instances[0], glm::vec3(0.0f)), {5, 2, 0});
    EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("roots of the scene are children")));
  }
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

TEST(GltfNodes, ProbeVolumesOfMirroredNodesHaveAxesThatAreARotation) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.show_node(
      {{"scale", {-2, 1, 1}}, {"extras", {{"lambent_probe_volume", {{"size", {4, 3, 2}}}}}}});
  const Expected<Scene> loaded = builder.load();
  ASSERT_TRUE(loaded) << error_of(loaded);
  expect_near(loaded->volumes.at(0).size, {8, 3, 2});
  EXPECT_NEAR(glm::determinant(loaded->volumes[0].axes), 1.0f, 1e-6f);
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

TEST(GltfNodes, FogStandsWhereItsNodeIs) {
  const float half = std::sqrt(0.5f);
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.show_node({{"name", "mist"},
                     {"translation", {1, 2, 3}},
                     {"rotation", {0, half, 0, half}},
                     {"scale", {2, 1, 0.5}},
                     {"extras",
                      {{"lambent_fog",
                        {{"size", {4, 3, 2}},
                         {"density", 0.25},
                         {"albedo", {0.1, 0.2, 0.3}},
                         {"anisotropy", 0.95},
                         {"scale_height", 7}}}}}});
  builder.show_node({{"extras", {{"lambent_fog", {{"albedo", 0.5}}}}}});
  const Expected<Scene> loaded = builder.load();
  ASSERT_TRUE(loaded) << error_of(loaded);
  ASSERT_EQ(loaded->fog.size(), 2u);
  const FogVolume& mist = loaded->fog[0];
  EXPECT_EQ(mist.name, "mist");
  expect_near(mist.centre, {1, 2, 3});
  expect_near(mist.size, {8, 3, 1});
  expect_near(mist.axes[0], {0, 0, -1});
  EXPECT_EQ(mist.density, 0.25f);
  expect_near(mist.albedo, {0.1f, 0.2f, 0.3f});
  EXPECT_EQ(mist.anisotropy, 0.95f);
  EXPECT_EQ(mist.scale_height, 7.0f);
  EXPECT_EQ(loaded->fog[1].albedo, glm::vec3(0.5f));
  EXPECT_EQ(loaded->fog[1].density, FogVolume{}.density);
  EXPECT_TRUE(loaded->source.warnings.empty());
}

TEST(GltfNodes, FogThatMakesNoSenseIsLeftOut) {
  using nlohmann::json;
  for (const json& fog :
       {json(3), json{{"size", {1, 2}}}, json{{"density", -1}}, json{{"density", 1e7}},
        json{{"density", "x"}}, json{{"albedo", 2}}, json{{"albedo", {1, 2, 1}}},
        json{{"anisotropy", 0.96}}, json{{"anisotropy", 1e300}}, json{{"scale_height", 0}},
        json{{"scale_height", 1e300}}, json{{"colour", 1}}}) {
    GltfBuilder builder;
    builder.show(builder.triangle());
    builder.show_node({{"extras", {{"lambent_fog", fog}}}});
    const Expected<Scene> loaded = builder.load();
    ASSERT_TRUE(loaded) << error_of(loaded);
    EXPECT_TRUE(loaded->fog.empty()) << fog;
    EXPECT_THAT(loaded->source.warnings, Contains(HasSubstr("nodes[1].extras.lambent_fog")));
  }
  // Neither does one in a node that is sheared, nor the seventeenth
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.show_node({{"matrix", {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
                     {"extras", {{"lambent_fog", json::object()}}}});
  for (std::size_t i = 0; i <= kMaxFogVolumes; ++i) {
    builder.show_node({{"extras", {{"lambent_fog", json::object()}}}});
  }
  const Expected<Scene> loaded = builder.load();
  ASSERT_TRUE(loaded) << error_of(loaded);
  EXPECT_EQ(loaded->fog.size(), kMaxFogVolumes);
  EXPECT_EQ(loaded->source.warnings.size(), 2u);
}

}  // namespace
}  // namespace lambent::gltf_nodes_test
