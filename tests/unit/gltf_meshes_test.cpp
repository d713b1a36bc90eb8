// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "unit/gltf_builder.h"

namespace lambent::gltf_meshes_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int kPoints = 0, kStrip = 5, kFan = 6;

glm::vec3 face_normal(const Mesh& mesh, std::size_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  return glm::normalize(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                   mesh.positions[t.z] - mesh.positions[t.x]));
}

// A zigzag of five vertices in the plane z = 0.
GltfBuilder zigzag(int mode, const std::vector<std::uint16_t>& indices = {}) {
  GltfBuilder builder;
  const int positions =
      builder.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
  const int normals =
      builder.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  Json primitive = {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"mode", mode}};
  if (!indices.empty()) primitive["indices"] = builder.accessor(indices, "SCALAR");
  builder.show(primitive);
  return builder;
}

TEST(GltfMeshes, StripsKeepTheirWinding) {
  const Expected<Scene> scene = zigzag(kStrip).load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  EXPECT_THAT(mesh.triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(1, 3, 2), glm::uvec3(2, 3, 4)));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(face_normal(mesh, i), glm::vec3(0, 0, 1));
}

TEST(GltfMeshes, FansTurnAboutTheirFirstVertex) {
  const Expected<Scene> scene = zigzag(kFan, {0, 1, 3, 2}).load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(1, 3, 0), glm::uvec3(3, 2, 0)));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(face_normal(mesh, i), glm::vec3(0, 0, 1));
}

TEST(GltfMeshes, AttributesThatAreNotFiniteAreReplaced) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  GltfBuilder builder = zigzag(kStrip);
  Json& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] =
      builder.accessor<float>({nan, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, infinite}, "VEC3");
  attributes["TEXCOORD_0"] =
      builder.accessor<float>({0, 1, nan, nan, 0, 1, 0.5f, infinite, 0, 1}, "VEC2");
  attributes["COLOR_0"] =
      builder.accessor<float>({0.5f, 0.5f, 0.5f, nan, 0, 0, 0, nan, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  attributes["TANGENT"] = builder.accessor<float>(
      {1, 0, 0, 1, nan, nan, nan, nan, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  builder.root["meshes"][0]["primitives"][0]["material"] = 0;
  builder.append("images",
                 {{"bufferView", builder.view(test::png_of(1, 1, {128, 128, 255, 255}))}});
  builder.append("textures", {{"source", 0}});
  builder.append("materials", {{"normalTexture", {{"index", 0}}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  for (const glm::vec3& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.uvs[0].at(0), glm::vec2(0, 1));
  EXPECT_EQ(mesh.uvs[0].at(1), glm::vec2(0, 0));
  EXPECT_EQ(mesh.uvs[0].at(3), glm::vec2(0, 0));
  EXPECT_EQ(mesh.colors.at(0), glm::vec4(0.5f, 0.5f, 0.5f, 1));
  EXPECT_EQ(mesh.colors.at(1), glm::vec4(1));
  ASSERT_THAT(mesh.tangents, SizeIs(5));
  EXPECT_NEAR(glm::length(glm::vec3(mesh.tangents[1])), 1.0f, 1e-6f);
  EXPECT_THAT(scene->source.warnings,
              testing::Contains(HasSubstr("7 attributes of vertices were not finite")));
}

TEST(GltfMeshes, PositionsThatAreNotFiniteAreErrors) {
  GltfBuilder builder = zigzag(kStrip);
  builder.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = builder.accessor<float>(
      {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, std::numeric_limits<float>::quiet_NaN(), 0, 0, 2, 0}, "VEC3");
  EXPECT_THAT(error_of(builder.load()), HasSubstr("element 3 holds a number that is not finite"));
}

TEST(GltfMeshes, PointsAreLeftOutWithAWarning) {
  const Expected<Scene> scene = zigzag(kPoints).load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->meshes.empty());
  EXPECT_THAT(scene->source.warnings, testing::Contains(HasSubstr("points or lines")));
  EXPECT_THAT(scene->source.warnings, testing::Contains(HasSubstr("no triangles")));
}

TEST(GltfMeshes, MissingNormalsAreFlat) {
  GltfBuilder builder;
  // A quad folded along its diagonal: the shared vertices need two normals each
  const int positions = builder.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1}, "VEC3");
  const int indices = builder.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
  builder.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  ASSERT_THAT(mesh.positions, SizeIs(6));
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 difference = mesh.normals[mesh.triangles[i][k]] - face_normal(mesh, i);
      EXPECT_LT(glm::length(difference), 1e-6f);
    }
  }
}

TEST(GltfMeshes, NormalsWithoutDirectionBecomeThatOfTheTriangle) {
  GltfBuilder builder;
  Json triangle = builder.triangle();
  triangle["attributes"]["NORMAL"] = builder.accessor<float>({0, 0, 0, 0, 0, 5, 0, 3, 0}, "VEC3");
  builder.show(triangle);
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->meshes.at(0).normals,
              ElementsAre(glm::vec3(0, 0, 1), glm::vec3(0, 0, 1), glm::vec3(0, 1, 0)));
  EXPECT_THAT(scene->source.warnings, ElementsAre(HasSubstr("1 normals without direction")));
}

TEST(GltfMeshes, QuantizedAttributesAreReadWithTheirScale) {
  GltfBuilder builder;
  builder.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int positions = builder.accessor<std::int16_t>({0, 0, 0, 100, 0, 0, 0, 200, 0}, "VEC3");
  const int normals =
      builder.accessor<std::int8_t>({0, 0, 127, 0, 0, 127, 0, 127, 0}, "VEC3", true);
  const int uvs = builder.accessor<std::uint16_t>({0, 0, 65535, 0, 0, 13107}, "VEC2", true);
  const int colors =
      builder.accessor<std::uint8_t>({255, 0, 51, 0, 0, 0, 255, 255, 255}, "VEC3", true);
  builder.show(
      {{"attributes",
        {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}, {"COLOR_0", colors}}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  EXPECT_EQ(mesh.positions[2], glm::vec3(0, 200, 0));
  EXPECT_EQ(mesh.normals[2], glm::vec3(0, 1, 0));
  EXPECT_EQ(mesh.uvs[0][2], glm::vec2(0, 0.2f));
  EXPECT_EQ(mesh.colors[0], glm::vec4(1, 0, 0.2f, 1));
}

TEST(GltfMeshes, TrianglesWithoutAreaAreDropped) {
  const Expected<Scene> scene = zigzag(kStrip, {0, 1, 2, 2, 3, 4}).load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->meshes.at(0).triangles, SizeIs(2));
  // Strips repeat corners where they turn
  EXPECT_THAT(scene->source.warnings, IsEmpty());
}

TEST(GltfMeshes, SliversWithoutAreaAreDroppedWithAWarning) {
  GltfBuilder builder;
  // The last corner is at the first one to within rounding, as those at poles of small spheres are
  const int positions = builder.accessor<float>(
      {0, 0, 0, 0.01f, 0, 0, 0, 0.01f, 0, 0.02f, 0, 0, 1e-19f, 0, 0}, "VEC3");
  const int indices =
      builder.accessor<std::uint16_t>({0, 1, 2, 0, 1, 3, 0, 0, 1, 0, 2, 4}, "SCALAR");
  builder.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->meshes.at(0).triangles, SizeIs(1));
  EXPECT_THAT(
      scene->source.warnings,
      ElementsAre("1 triangles without area were dropped, first in meshes[0].primitives[0]."));
}

TEST(GltfMeshes, VerticesThatNoTriangleUsesAreDropped) {
  const Expected<Scene> scene = zigzag(kStrip, {1, 3, 2}).load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  EXPECT_THAT(mesh.positions,
              ElementsAre(glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(1, 1, 0)));
  EXPECT_THAT(mesh.normals, SizeIs(3));
  EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 2, 1)));
}

TEST(GltfMeshes, IndicesOutOfRangeNameTheAccessor) {
  EXPECT_THAT(error_of(zigzag(kFan, {0, 1, 5}).load()),
              HasSubstr("accessors[2]: index 5 at 2 is out of range"));
}

TEST(GltfMeshes, PositionsThatAreNotNumbersNameTheAccessor) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(builder.bytes.data() + 16, &nan, sizeof nan);
  EXPECT_THAT(error_of(builder.load()), HasSubstr("accessors[0]: element 1"));
}

TEST(GltfMeshes, CoordinatesOutOfRangeNameTheVertex) {
  for (const float far : {2e9f, -1e15f, 1e19f, 3e38f}) {
    GltfBuilder builder;
    const int positions = builder.accessor<float>({0, 0, 0, far, 0, 0, 0, far, 0}, "VEC3");
    builder.show({{"attributes", {{"POSITION", positions}}}});
    EXPECT_THAT(error_of(builder.load()),
                HasSubstr("meshes[0].primitives[0]: vertex 1 has a coordinate that is not within "
                          "-1e9 to 1e9 m"))
        << far;
  }
}

TEST(GltfMeshes, LargeTrianglesHaveArea) {
  GltfBuilder builder;
  const int positions =
      builder.accessor<float>({-1e9f, -1e9f, 0, 1e9f, -1e9f, 0, 1e9f, 1e9f, 1e9f}, "VEC3");
  builder.show({{"attributes", {{"POSITION", positions}}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(triangle_count(*scene), 1u);
}

TEST(GltfMeshes, TextureCoordinatesOutOfRangeBecomeZero) {
  GltfBuilder builder;
  Json primitive = builder.triangle();
  primitive["attributes"]["TEXCOORD_0"] =
      builder.accessor<float>({1e30f, 1, 0.5f, -1e30f, 0.25f, 0.75f}, "VEC2");
  builder.show(primitive);
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->meshes.at(0).uvs[0],
              testing::ElementsAre(glm::vec2(0), glm::vec2(0), glm::vec2(0.25f, 0.75f)));
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("2 texture coordinates beyond 1e8")));
}

TEST(GltfMeshes, AttributesMustHaveOneElementAVertex) {
  GltfBuilder builder;
  Json triangle = builder.triangle();
  triangle["attributes"]["TEXCOORD_0"] = builder.accessor<float>({0, 0, 1, 1}, "VEC2");
  builder.show(triangle);
  EXPECT_THAT(
      error_of(builder.load()),
      HasSubstr("meshes[0].primitives[0].attributes.TEXCOORD_0: has 2 elements for 3 vertices"));
}

TEST(GltfMeshes, PositionsMustBeVectors) {
  GltfBuilder builder;
  builder.show({{"attributes", {{"POSITION", builder.accessor<float>({0, 0, 1, 0}, "VEC2")}}}});
  EXPECT_THAT(error_of(builder.load()), HasSubstr("has 2 components where 3 are needed"));
}

// A quad in z = 0 whose texture coordinates are `uvs`, with a material that has a normal map.
GltfBuilder normal_mapped(const std::vector<float>& uvs) {
  GltfBuilder builder;
  const int positions = builder.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  const int normals = builder.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int coordinates = builder.accessor(uvs, "VEC2");
  const int indices = builder.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
  builder.append("images", {{"bufferView", builder.view(test::png_of(1, 1, {128, 128, 255, 255}))},
                            {"mimeType", "image/png"}});
  builder.append("textures", {{"source", 0}});
  builder.append("materials", {{"normalTexture", {{"index", 0}}}});
  builder.show(
      {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", coordinates}}},
       {"indices", indices},
       {"material", 0}});
  return builder;
}

TEST(GltfMeshes, TangentsFollowTheTextureCoordinates) {
  // u grows with x, v with -y: an upright image, whose bitangent is +y
  const Expected<Scene> scene = normal_mapped({0, 1, 1, 1, 1, 0, 0, 0}).load();
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->meshes.at(0).tangents, SizeIs(4));
  for (const glm::vec4& tangent : scene->meshes[0].tangents) {
    EXPECT_EQ(tangent, glm::vec4(1, 0, 0, 1));
  }
}

TEST(GltfMeshes, VerticesAreSplitWhereTextureCoordinatesMirror) {
  // The first triangle is upright, the second mirrored in u: they share vertices 0 and 2
  const Expected<Scene> scene = normal_mapped({0, 1, 1, 1, 1, 0, 2, 0}).load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  EXPECT_THAT(mesh.positions, SizeIs(6));
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(mesh.tangents[mesh.triangles[0][k]].w, 1.0f);
    EXPECT_EQ(mesh.tangents[mesh.triangles[1][k]].w, -1.0f);
  }
}

TEST(GltfMeshes, WithoutNormalMapsThereAreNoTangents) {
  LoadOptions options;
  options.normal_maps = false;
  const Expected<Scene> scene = normal_mapped({0, 1, 1, 1, 1, 0, 0, 0}).load(options);
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(scene->meshes.at(0).tangents.empty());
  EXPECT_TRUE(scene->textures.empty());
}

TEST(GltfMeshes, DefaultMorphWeightsAreApplied) {
  GltfBuilder builder;
  Json triangle = builder.triangle();
  const int offsets = builder.accessor<float>({0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3");
  triangle["targets"] = Json::array({{{"POSITION", offsets}}});
  const int mesh = builder.show(triangle);
  builder.root["meshes"][mesh]["weights"] = {0.5};
  builder.show_node({{"mesh", mesh}, {"weights", {0.0}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->instances, SizeIs(2));
  EXPECT_EQ(scene->meshes[scene->instances[0].mesh].positions[0].z, 1.0f);
  EXPECT_EQ(scene->meshes[scene->instances[1].mesh].positions[0].z, 0.0f);
}

TEST(GltfMeshes, SkinsStandWhereTheirJointsAre) {
  GltfBuilder builder;
  Json triangle = builder.triangle();
  triangle["attributes"]["JOINTS_0"] =
      builder.accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  triangle["attributes"]["WEIGHTS_0"] =
      builder.accessor<float>({1, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4");
  const int mesh = builder.append("meshes", {{"primitives", Json::array({triangle})}});
  const int left = builder.show_node({{"translation", {-1, 0, 0}}});
  const int right = builder.show_node({{"translation", {3, 0, 0}}});
  builder.append("skins", {{"joints", {left, right}}});
  // The node's own place does not count
  builder.show_node({{"mesh", mesh}, {"skin", 0}, {"translation", {0, 100, 0}}});
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(scene->instances.at(0).world_from_object, glm::mat4(1.0f));
  EXPECT_THAT(scene->meshes.at(0).positions,
              ElementsAre(glm::vec3(-1, 0, 0), glm::vec3(4, 0, 0), glm::vec3(1, 1, 0)));
}

TEST(GltfMeshes, JointsThatDoNotExistAreErrors) {
  GltfBuilder builder;
  Json triangle = builder.triangle();
  triangle["attributes"]["JOINTS_0"] =
      builder.accessor<std::uint8_t>({0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  triangle["attributes"]["WEIGHTS_0"] =
      builder.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const int mesh = builder.append("meshes", {{"primitives", Json::array({triangle})}});
  const int joint = builder.show_node(Json::object());
  builder.append("skins", {{"joints", {joint}}});
  builder.show_node({{"mesh", mesh}, {"skin", 0}});
  EXPECT_THAT(error_of(builder.load()), HasSubstr("vertex 1 refers to a joint"));
}

}  // namespace
}  // namespace lambent::gltf_meshes_test
