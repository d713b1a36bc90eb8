// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "unit/gltf_builder.h"

namespace lambent::gltf_compression_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using testing::HasSubstr;
using testing::SizeIs;

using Bytes = std::vector<std::uint8_t>;

// Two triangles of a square, quantized to 14 bits.
Bytes draco_square() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), corners[0], corners[1],
                                    corners[2]);
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(1), corners[0], corners[2],
                                    corners[3]);
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  constexpr int kPositionBits = 14;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, kPositionBits);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

// As exporters write it: the accessors have no buffer views.
GltfBuilder with_draco(const Bytes& stream, int attribute_id) {
  GltfBuilder builder;
  builder.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const int view = builder.view(stream);
  builder.append("accessors", {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  builder.append("accessors", {{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}});
  builder.show({{"attributes", {{"POSITION", 0}}},
                {"indices", 1},
                {"extensions",
                 {{"KHR_draco_mesh_compression",
                   {{"bufferView", view}, {"attributes", {{"POSITION", attribute_id}}}}}}}});
  return builder;
}

TEST(GltfDraco, DecodesPositionsAndIndices) {
  const Expected<Scene> scene = with_draco(draco_square(), 0).load();
  ASSERT_TRUE(scene) << error_of(scene);
  const Mesh& mesh = scene->meshes.at(0);
  ASSERT_THAT(mesh.triangles, SizeIs(2));
  const Bounds bounds = world_bounds(*scene);
  EXPECT_LT(glm::length(bounds.min - glm::vec3(0, 0, 0)), 1e-4f);
  EXPECT_LT(glm::length(bounds.max - glm::vec3(1, 1, 0)), 1e-4f);
  for (const glm::vec3& normal : mesh.normals) EXPECT_GT(normal.z, 0.999f);
}

TEST(GltfDraco, HoldsTrianglesWhateverTheModeSays) {
  GltfBuilder builder = with_draco(draco_square(), 0);
  constexpr int kTriangleStrip = 5;
  builder.root["meshes"][0]["primitives"][0]["mode"] = kTriangleStrip;
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->meshes.at(0).triangles, SizeIs(2));
}

TEST(GltfDraco, CorruptStreamsAreErrors) {
  const Bytes stream = draco_square();
  EXPECT_THAT(error_of(with_draco(stream, 7).load()), HasSubstr("has no attribute 7"));
  for (std::size_t size = 1; size < stream.size(); ++size) {
    const Bytes truncated(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(with_draco(truncated, 0).load()) << size;
  }
  EXPECT_THAT(error_of(with_draco(Bytes(16, 0xaa), 0).load()),
              HasSubstr("meshes[0].primitives[0] (bufferViews[0]): the Draco stream is corrupt"));
}

template <class T>
Bytes compress_vertices(const std::vector<T>& vertices) {
  Bytes out(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(T)));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), vertices.data(), vertices.size(),
                                        sizeof(T)));
  return out;
}

// Replaces a view by its compressed stream, with a fallback buffer that has no bytes.
void set_compressed(GltfBuilder& builder, int view, const Bytes& stream, int count, int stride,
                    const char* mode, const char* filter = nullptr) {
  Json extension = {{"buffer", 0},          {"byteOffset", 0}, {"byteLength", stream.size()},
                    {"byteStride", stride}, {"count", count},  {"mode", mode}};
  const int stream_view = builder.view(stream);
  extension["byteOffset"] = builder.root["bufferViews"][stream_view]["byteOffset"];
  if (filter) extension["filter"] = filter;
  builder.root["bufferViews"][view] = {{"buffer", 1},
                                       {"byteLength", count * stride},
                                       {"extensions", {{"EXT_meshopt_compression", extension}}}};
}

void add_fallback_buffer(GltfBuilder& builder) {
  builder.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  builder.root["buffers"] =
      Json::array({{{"byteLength", builder.bytes.size()}},
                   {{"byteLength", 100000},
                    {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
}

const std::vector<glm::vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<std::uint32_t> kSquareIndices = {0, 1, 2, 0, 2, 3};

GltfBuilder meshopt_square(const char* index_mode) {
  GltfBuilder builder;
  const int positions = builder.accessor<float>(std::vector<float>(12), "VEC3");
  const int indices = builder.accessor<std::uint16_t>(std::vector<std::uint16_t>(6), "SCALAR");
  builder.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  set_compressed(builder, 0, compress_vertices(kSquare), 4, 12, "ATTRIBUTES");
  Bytes stream(1000);
  const std::size_t count = kSquareIndices.size();
  stream.resize(
      std::string(index_mode) == "TRIANGLES"
          ? meshopt_encodeIndexBuffer(stream.data(), stream.size(), kSquareIndices.data(), count)
          : meshopt_encodeIndexSequence(stream.data(), stream.size(), kSquareIndices.data(),
                                        count));
  set_compressed(builder, 1, stream, 6, 2, index_mode);
  add_fallback_buffer(builder);
  return builder;
}

TEST(GltfMeshopt, DecodesAttributesAndBothKindsOfIndices) {
  for (const char* mode : {"TRIANGLES", "INDICES"}) {
    const Expected<Scene> scene = meshopt_square(mode).load();
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(triangle_count(*scene), 2u);
    EXPECT_EQ(world_bounds(*scene).max, glm::vec3(1, 1, 0));
    for (const glm::vec3& normal : scene->meshes.at(0).normals)
      EXPECT_EQ(normal, glm::vec3(0, 0, 1));
  }
}

TEST(GltfMeshopt, OctahedralFilterGivesUnitNormals) {
  const std::vector<glm::vec4> normals = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}};
  std::vector<std::uint32_t> filtered(3);
  meshopt_encodeFilterOct(filtered.data(), 3, 4, 8, &normals[0].x);
  GltfBuilder builder;
  Json triangle = builder.triangle();
  triangle["attributes"]["NORMAL"] = 1;
  const int view = builder.view(std::vector<std::uint8_t>(12));
  builder.append("accessors", {{"bufferView", view},
                               {"componentType", 5120},
                               {"count", 3},
                               {"type", "VEC3"},
                               {"normalized", true}});
  builder.root["bufferViews"][view]["byteStride"] = 4;
  builder.show(triangle);
  set_compressed(builder, view, compress_vertices(filtered), 3, 4, "ATTRIBUTES", "OCTAHEDRAL");
  builder.root["bufferViews"][view]["byteStride"] = 4;
  add_fallback_buffer(builder);
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(glm::dot(scene->meshes.at(0).normals[i], glm::vec3(normals[i])), 0.999f) << i;
  }
}

TEST(GltfMeshopt, ExponentialFilterGivesFloats) {
  std::vector<glm::vec3> filtered(4);
  meshopt_encodeFilterExp(filtered.data(), 4, 12, 15, &kSquare[0].x);
  GltfBuilder builder = meshopt_square("TRIANGLES");
  builder.root.erase("buffers");
  set_compressed(builder, 0, compress_vertices(filtered), 4, 12, "ATTRIBUTES", "EXPONENTIAL");
  add_fallback_buffer(builder);
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_LT(glm::length(world_bounds(*scene).max - glm::vec3(1, 1, 0)), 1e-3f);
}

TEST(GltfMeshopt, QuaternionFilterTurnsInstances) {
  // Half a turn about z, then none
  const std::vector<glm::vec4> rotations = {{0, 0, 1, 0}, {0, 0, 0, 1}};
  std::vector<std::uint64_t> filtered(2);
  constexpr int kBits = 12;
  meshopt_encodeFilterQuat(filtered.data(), 2, 8, kBits, &rotations[0].x);
  GltfBuilder builder;
  const int mesh = builder.append("meshes", {{"primitives", Json::array({builder.triangle()})}});
  const int rotation = builder.accessor<std::int16_t>(std::vector<std::int16_t>(8), "VEC4", true);
  builder.show_node(
      {{"mesh", mesh},
       {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"ROTATION", rotation}}}}}}}});
  const int view = builder.root["accessors"][rotation]["bufferView"].get<int>();
  set_compressed(builder, view, compress_vertices(filtered), 2, 8, "ATTRIBUTES", "QUATERNION");
  add_fallback_buffer(builder);
  const Expected<Scene> scene = builder.load();
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->instances, SizeIs(2));
  EXPECT_NEAR(scene->instances[0].world_from_object[0].x, -1.0f, 1e-3f);
  EXPECT_NEAR(scene->instances[1].world_from_object[0].x, 1.0f, 1e-3f);
}

TEST(GltfMeshopt, BrokenStreamsAreErrors) {
  const char* pointer = "/bufferViews/0/extensions/EXT_meshopt_compression/";
  const std::pair<const char*, Json> cases[] = {
      {"byteLength", 1000000},
      {"byteLength", 3},
      {"byteOffset", 900000},
      {"count", 2000000000},
      {"count", 3},
      {"byteStride", 5},
      {"mode", "ZIP"},
      {"filter", "OCTAHEDRAL"},
      {"filter", "QUATERNION"},
      {"filter", "BLUR"},
      {"mode", "TRIANGLES"},
  };
  for (const auto& [key, value] : cases) {
    GltfBuilder builder = meshopt_square("TRIANGLES");
    builder.root[Json::json_pointer(pointer + std::string(key))] = value;
    EXPECT_THAT(error_of(builder.load()), HasSubstr("bufferViews[0]")) << key << value;
  }
}

TEST(GltfMeshopt, UncompressedViewsOfAFallbackBufferAreErrors) {
  GltfBuilder builder = meshopt_square("TRIANGLES");
  builder.root["bufferViews"][0].erase("extensions");
  EXPECT_THAT(error_of(builder.load()),
              HasSubstr("bufferViews[0]: extends beyond the end of buffers[1]"));
}

}  // namespace
}  // namespace lambent::gltf_compression_test
