// SPDX-License-Identifier: Apache-2.0
// Files whose scene stands far from the origin: georeferenced, or out of a city's CAD.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "scenes/glb_writer.h"
#include "unit/gltf_checks.h"

namespace lambent::gltf_origin_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using test::loaded;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Far away, and not a round number in binary nor in decimal.
const glm::dvec3 kFar(123456.7, 12.3, -98765.4);

Json list_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// Where a point of an instance's mesh is in the file's coordinates.
glm::dvec3 in_file(const Scene& scene, std::size_t instance, std::size_t vertex) {
  const Instance& placed = scene.instances.at(instance);
  const glm::vec3 position = scene.meshes.at(placed.mesh).positions.at(vertex);
  return glm::dvec3(placed.world_from_object * glm::vec4(position, 1.0f)) + scene.source.origin;
}

void expect_near(const glm::dvec3& actual, const glm::dvec3& expected) {
  EXPECT_LT(glm::length(actual - expected), 1e-6) << actual.x << " " << actual.y << " " << actual.z;
}

TEST(GltfOrigin, IsTheFilesWhereScenesAreNear) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.root["nodes"][0]["translation"] = {9, 0, -14};
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.source.origin, glm::dvec3(0.0));
  EXPECT_EQ(glm::vec3(scene.instances[0].world_from_object[3]), glm::vec3(9, 0, -14));
  EXPECT_THAT(scene.source.warnings, IsEmpty());
}

TEST(GltfOrigin, IsARoundNumberInTheMidstOfFarScenesAndTold) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.root["nodes"][0]["translation"] = list_of(kFar);
  builder.root["nodes"][0]["scale"] = {30, 30, 30};
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.source.origin, glm::dvec3(123470, 30, -98770));
  ASSERT_EQ(scene.source.warnings.size(), 1u);
  EXPECT_THAT(scene.source.warnings[0], HasSubstr("are the file's less (123470, 30, -98770) m"));
}

TEST(GltfOrigin, OfNodesKeepsWhatDoublesKnow) {
  // The node's parents take it there and half the way back
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.root["nodes"][0]["translation"] = list_of(-kFar);
  builder.append("nodes", {{"children", {0}}, {"translation", list_of(2.0 * kFar)}});
  builder.root["scenes"][0]["nodes"] = {1};
  const Scene scene = loaded(builder);
  expect_near(in_file(scene, 0, 0), kFar);
  expect_near(in_file(scene, 0, 1), kFar + glm::dvec3(1, 0, 0));
}

TEST(GltfOrigin, OfVerticesKeepsTheBitsOfTheFile) {
  // Eighths of a millimetre are what floats have left out there
  const std::vector<float> far = {100000.0078125f, 3.1f,     -7.0f, 100001.5f, 3.1f,
                                  -7.25f,          99999.0f, 3.25f, -7.0f};
  GltfBuilder builder;
  const int positions = builder.accessor<float>(far, "VEC3");
  const int mesh = builder.show({{"attributes", {{"POSITION", positions}}}});
  // Once more, turned over and brought back to where the first one is
  builder.show_node({{"mesh", mesh}, {"rotation", {0, 1, 0, 0}}, {"translation", {2e5, 0, 0}}});
  const Scene scene = loaded(builder);
  for (std::size_t v = 0; v < 3; ++v) {
    const glm::dvec3 stored(far[3 * v], far[3 * v + 1], far[3 * v + 2]);
    expect_near(in_file(scene, 0, v), stored);
    expect_near(in_file(scene, 1, v), {2e5 - stored.x, stored.y, -stored.z});
  }
}

TEST(GltfOrigin, IsSubtractedWhereNodesBringFarVerticesBack) {
  GltfBuilder builder;
  const int positions = builder.accessor<float>({1e6f, 0, 0, 1e6f + 1, 0, 0, 1e6f, 1, 0}, "VEC3");
  builder.show({{"attributes", {{"POSITION", positions}}}});
  builder.root["nodes"][0]["translation"] = {-1e6 + 0.1, 0, 0};
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.source.origin, glm::dvec3(0.0));
  expect_near(in_file(scene, 0, 1), {1.1, 0, 0});
}

/// A triangle, a light, a camera, a box of fog and one of probes, below a root that stands there.
GltfBuilder furnished(const glm::dvec3& place) {
  GltfBuilder builder;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.append("cameras", Json::parse(R"({"type": "perspective",
      "perspective": {"yfov": 1.0, "znear": 0.1}})"));
  const int translations = builder.accessor<float>({0, 0, 0, 3.3f, 0, 0}, "VEC3");
  Json instances = {{"mesh", 0}, {"translation", {0, 0.7, 0}}};
  instances["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translations}};
  Json light = {{"translation", {1, 2, 3}}};
  light["extensions"]["KHR_lights_punctual"]["light"] = 0;
  builder.show(builder.triangle());
  builder.append("nodes", instances);
  builder.append("nodes", light);
  builder.append("nodes", {{"camera", 0}, {"translation", {0, 1, 5}}});
  builder.append(
      "nodes",
      {{"translation", {0.5, 0, 0}},
       {"extras",
        {{"lambent_fog", {{"density", 0.1}}}, {"lambent_probe_volume", {{"spacing", 0.5}}}}}});
  builder.append("nodes", {{"children", {0, 1, 2, 3, 4}}, {"translation", list_of(place)}});
  builder.root["scenes"][0]["nodes"] = {5};
  return builder;
}

TEST(GltfOrigin, IsThatOfAllThatStandsSomewhere) {
  const Scene near = loaded(furnished({}));
  const Scene far = loaded(furnished(kFar));
  ASSERT_NE(far.source.origin, glm::dvec3(0.0));
  const glm::dvec3 way = kFar - far.source.origin;
  const auto moved = [&](const glm::vec3& a, const glm::vec3& b) {
    expect_near(glm::dvec3(b), glm::dvec3(a) + way);
  };
  ASSERT_EQ(far.instances.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    moved(near.instances[i].world_from_object[3], far.instances[i].world_from_object[3]);
  }
  moved(near.lights.at(0).position_ws, far.lights.at(0).position_ws);
  moved(near.cameras.at(0).world_from_view[3], far.cameras.at(0).world_from_view[3]);
  moved(near.fog.at(0).centre, far.fog.at(0).centre);
  moved(near.volumes.at(0).centre, far.volumes.at(0).centre);
}

/// Animates the translation of a node: a step of 1 m along x in a second.
void move(GltfBuilder& builder, int node, const glm::vec3& rest) {
  const int times = builder.accessor<float>({0, 1}, "SCALAR");
  const int values =
      builder.accessor<float>({rest.x, rest.y, rest.z, rest.x + 1.0f, rest.y, rest.z}, "VEC3");
  builder.append(
      "animations",
      {{"samplers", {{{"input", times}, {"output", values}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
}

TEST(GltfOrigin, IsKeptByWhatMoves) {
  GltfBuilder builder = furnished(kFar);
  for (const auto& [node, rest] : {std::pair{0, glm::vec3(0.0f)},
                                   {1, glm::vec3(0.0f, 0.7f, 0.0f)},
                                   {2, glm::vec3(1, 2, 3)},
                                   {3, glm::vec3(0, 1, 5)}}) {
    move(builder, node, rest);
  }
  const Scene rest = loaded(builder);
  Scene scene = rest;
  ASSERT_TRUE(validate(scene));
  for (const float time : {0.0f, 0.5f}) {
    animate(scene, -1, time);
    const glm::vec3 way(time, 0, 0);
    const auto moved = [&](const glm::vec3& a, const glm::vec3& b) {
      expect_near(glm::dvec3(b), glm::dvec3(a + way));
    };
    for (std::size_t i = 0; i < 3; ++i) {
      moved(rest.instances[i].world_from_object[3], scene.instances[i].world_from_object[3]);
    }
    moved(rest.lights[0].position_ws, scene.lights[0].position_ws);
    moved(rest.cameras[0].world_from_view[3], scene.cameras[0].world_from_view[3]);
  }
}

/// A triangle that a joint, node 1, carries by a bind pose. All places are in the file's numbers.
GltfBuilder skinned(const glm::vec3& vertices, const glm::dvec3& joint) {
  GltfBuilder builder;
  const int positions =
      builder.accessor<float>({vertices.x, vertices.y, vertices.z, vertices.x + 1, vertices.y,
                               vertices.z, vertices.x, vertices.y + 1, vertices.z},
                              "VEC3");
  Json primitive = {{"attributes", {{"POSITION", positions}}}};
  primitive["attributes"]["JOINTS_0"] =
      builder.accessor<std::uint8_t>(std::vector<std::uint8_t>(12), "VEC4");
  primitive["attributes"]["WEIGHTS_0"] =
      builder.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  builder.show(primitive);
  builder.show_node({{"translation", {0, 0, 0}}});
  builder.append("nodes", {{"children", {1}}, {"translation", list_of(joint)}});
  builder.root["scenes"][0]["nodes"] = {0, 2};
  const std::vector<float> bind = {1, 0, 0, 0, 0,           1,           0,           0,
                                   0, 0, 1, 0, -vertices.x, -vertices.y, -vertices.z, 1};
  const int matrices = builder.append("accessors", {{"bufferView", builder.view<float>(bind)},
                                                    {"componentType", 5126},
                                                    {"count", 1},
                                                    {"type", "MAT4"}});
  builder.append("skins", {{"joints", {1}}, {"inverseBindMatrices", matrices}});
  builder.root["nodes"][0]["skin"] = 0;
  return builder;
}

TEST(GltfOrigin, OfSkinsIsTheWorldsInTheEnd) {
  // Far in the world alone, and in the bind pose, too
  for (const glm::vec3& vertices : {glm::vec3(0.0f), glm::vec3(1e6f, 0.0f, 5.0f)}) {
    GltfBuilder builder = skinned(vertices, kFar);
    expect_near(in_file(loaded(builder), 0, 1), kFar + glm::dvec3(1, 0, 0));
    move(builder, 1, glm::vec3(0.0f));
    Scene scene = loaded(builder);
    ASSERT_EQ(scene.rig.meshes.size(), 1u);
    for (const float time : {0.5f, 0.0f}) {
      animate(scene, 0, time);
      expect_near(in_file(scene, 0, 1), kFar + glm::dvec3(1.0 + time, 0, 0));
    }
  }
}

TEST(GltfOrigin, WarningsOfRepairsAreToldOnce) {
  GltfBuilder builder;
  const int positions = builder.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0}, "VEC3");
  const int indices = builder.accessor<std::uint16_t>({0, 1, 2, 0, 1, 3}, "SCALAR");
  builder.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  builder.root["nodes"][0]["translation"] = list_of(kFar);
  EXPECT_THAT(loaded(builder).source.warnings,
              ElementsAre(HasSubstr("It was moved"), HasSubstr("1 triangles without area")));
}

/// A .glb whose roots are children of a new one, which stands there.
std::string moved(const std::string& glb, const glm::dvec3& place) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, glb.data() + at, sizeof value);
    return value;
  };
  const std::size_t size = word(12);
  Json root = Json::parse(glb.substr(20, size));
  root["nodes"].push_back(
      {{"children", root["scenes"][0]["nodes"]}, {"translation", list_of(place)}});
  root["scenes"][0]["nodes"] = {root["nodes"].size() - 1};
  std::string text = root.dump();
  while (text.size() % 4 != 0) text += ' ';
  const std::string binary = glb.substr(20 + size);
  const std::uint32_t header[] = {word(0), word(4),
                                  static_cast<std::uint32_t>(20 + text.size() + binary.size()),
                                  static_cast<std::uint32_t>(text.size()), word(16)};
  return std::string(reinterpret_cast<const char*>(header), sizeof header) + text + binary;
}

Image picture_of(const std::string& glb) {
  const Expected<Scene> scene =
      load_scene_from_memory({reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size()});
  if (!scene) throw std::runtime_error(error_of(scene));
  const World world(*scene);
  FieldSettings settings;
  IrradianceField field = *IrradianceField::make(settings, world_bounds(*scene));
  for (int i = 0; i < 4; ++i) field.update(world);
  Renderer renderer(world, IndirectSources{&field});
  FrameSettings frame;
  frame.width = 48;
  frame.height = 48;
  return *renderer.render(scene->cameras.at(0), frame)->image.find("");
}

TEST(GltfOrigin, LeavesPicturesOfFarScenesAsThoseOfNearOnes) {
  const auto made = scenes::make("cornell");
  ASSERT_TRUE(made);
  const Expected<std::string> glb = scenes::encode_glb(*made);
  ASSERT_TRUE(glb);
  const Image near = picture_of(*glb), far = picture_of(moved(*glb, kFar));
  double sum = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < near.pixels.size(); ++i) {
    sum += near.pixels[i];
    difference += std::abs(near.pixels[i] - far.pixels[i]);
  }
  // Coordinates are rounded elsewhere, so that a ray in thousands meets the other of two neighbours
  EXPECT_LT(difference, 0.01 * sum);
}

}  // namespace
}  // namespace lambent::gltf_origin_test
