// SPDX-License-Identifier: Apache-2.0
// Hostile and broken files: each fails with a message that names the place and the cause.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene/gltf/document/extensions.h"
#include "scene/gltf/files.h"
#include "unit/gltf_builder.h"

namespace lambent::gltf_container_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using test::load_text;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

// Three vertices in 36 bytes, base64.
constexpr const char* kTriangleUri =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

Json triangle_with(const Json& buffer) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  builder.root["buffers"] = Json::array({buffer});
  return builder.root;
}

class GltfFile : public testing::Test {
 protected:
  GltfFile() {
    folder = std::filesystem::path(testing::TempDir()) /
             testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder / "sub");
  }
  ~GltfFile() override { std::filesystem::remove_all(folder); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return (folder / name).string();
  }

  std::filesystem::path folder;
};

TEST_F(GltfFile, ReadsBuffersBesideAndAboveIt) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  write("a b.bin", std::string(builder.bytes.begin(), builder.bytes.end()));
  const Json beside = triangle_with({{"byteLength", 36}, {"uri", "a%20b.bin"}});
  EXPECT_EQ(error_of(load_scene(write("beside.gltf", beside.dump()))), "");
  const Json above = triangle_with({{"byteLength", 36}, {"uri", "../a b.bin"}});
  EXPECT_EQ(error_of(load_scene(write("sub/above.gltf", above.dump()))), "");
}

TEST_F(GltfFile, BackslashesPartFoldersWhereNoFileIsNamedWithThem) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const std::string bytes(builder.bytes.begin(), builder.bytes.end());
  write("sub/in folder.bin", bytes);
  const Json below = triangle_with({{"byteLength", 36}, {"uri", "sub\\in%20folder.bin"}});
  const std::string scene = write("below.gltf", below.dump());
  EXPECT_EQ(error_of(load_scene(scene)), "");
  EXPECT_THAT(files_of_gltf(scene),
              testing::ElementsAre((folder / "sub" / "in folder.bin").string()));
  // A file of that very name is the one that is meant
  write("a\\b.bin", bytes);
  write("a/b.bin", "too short");
  const Json named = triangle_with({{"byteLength", 36}, {"uri", "a\\b.bin"}});
  EXPECT_EQ(error_of(load_scene(write("named.gltf", named.dump()))), "");
}

TEST_F(GltfFile, MissingFilesAreNamed) {
  EXPECT_THAT(error_of(load_scene((folder / "none.gltf").string())),
              HasSubstr("none.gltf: no such file"));
  EXPECT_THAT(error_of(load_scene(folder.string())), HasSubstr("is a directory"));
  const Json root = triangle_with({{"byteLength", 36}, {"uri", "none.bin"}});
  const std::string error = error_of(load_scene(write("a.gltf", root.dump())));
  EXPECT_THAT(error, HasSubstr("a.gltf: buffers[0]"));
  EXPECT_THAT(error, HasSubstr("none.bin): no such file"));
}

TEST_F(GltfFile, MissingImagesAreNamedWithTheirMaterials) {
  Json root = triangle_with({{"byteLength", 36}, {"uri", kTriangleUri}});
  root["images"] = Json::parse(R"([{"uri": "unused.png"}, {"uri": "none.png"}])");
  root["textures"] = Json::parse(R"([{"source": 1}])");
  root["materials"] = Json::parse(R"([{"name": "wall", "normalTexture": {"index": 0}}])");
  const Expected<Scene> scene = load_scene(write("a.gltf", root.dump()));
  ASSERT_TRUE(scene) << error_of(scene);
  ASSERT_THAT(scene->source.warnings, SizeIs(1));
  EXPECT_THAT(scene->source.warnings[0], HasSubstr("1 texture could not be read"));
  EXPECT_THAT(scene->source.warnings[0], HasSubstr("images[1]"));
  EXPECT_THAT(scene->source.warnings[0], HasSubstr("none.png): no such file, in material 'wall'"));
}

TEST_F(GltfFile, TruncatedBuffersAreNamed) {
  write("short.bin", "12345");
  const Json root = triangle_with({{"byteLength", 36}, {"uri", "short.bin"}});
  EXPECT_THAT(error_of(load_scene(write("a.gltf", root.dump()))),
              HasSubstr("buffers[0]: the buffer is truncated: it should have 36 bytes, but has 5"));
}

TEST(GltfUri, DataIsDecoded) {
  const Json root = triangle_with({{"byteLength", 36}, {"uri", kTriangleUri}});
  const Expected<Scene> scene = load_text(root.dump());
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_EQ(scene->meshes.at(0).positions.at(1), glm::vec3(1, 0, 0));
}

TEST(GltfUri, WhatIsNoFileBesideTheSceneIsRefused) {
  const auto error = [](const char* uri) {
    return error_of(load_text(triangle_with({{"byteLength", 36}, {"uri", uri}}).dump()));
  };
  EXPECT_THAT(error("https://example.org/a.bin"), HasSubstr("nothing is downloaded"));
  EXPECT_THAT(error("file:///etc/passwd"), HasSubstr("nothing is downloaded"));
  EXPECT_THAT(error("//host/a.bin"), HasSubstr("nothing is downloaded"));
  EXPECT_THAT(error("/etc/passwd"), HasSubstr("absolute"));
  EXPECT_THAT(error("%2fetc/passwd"), HasSubstr("absolute"));
  EXPECT_THAT(error("a:b.bin"), HasSubstr("nothing is downloaded"));
  for (const char* path : {"C:\\Users\\me\\a.bin", "d:/a.bin", "C%3A%5Ca.bin"}) {
    EXPECT_THAT(error(path), HasSubstr(std::string(path) + " is an absolute path on another"));
    EXPECT_THAT(error(path), HasSubstr("put the file beside the scene's"));
  }
  EXPECT_THAT(error(""), HasSubstr("malformed"));
  EXPECT_THAT(error("a%00b"), HasSubstr("malformed"));
  EXPECT_THAT(error("data:,abc"), HasSubstr("not base64"));
  EXPECT_THAT(error("data:;base64,a*b="), HasSubstr("not base64"));
  EXPECT_THAT(error("data:;base64,AAAA"), HasSubstr("buffers[0]: the buffer is truncated"));
}

TEST(GltfGlb, EveryTruncationIsAnErrorOrTheSameScene) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  const auto file = builder.glb();
  ASSERT_TRUE(load_scene_from_memory(file));
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_FALSE(load_scene_from_memory(std::span(file).first(size))) << size;
  }
}

TEST(GltfGlb, ChunksThatDoNotFitAreErrors) {
  GltfBuilder builder;
  builder.show(builder.triangle());
  auto file = builder.glb();
  file[12] = 0xff;
  file[15] = 0xff;
  EXPECT_THAT(error_of(load_scene_from_memory(file)), HasSubstr("chunks[0]: the chunk extends"));
  file = builder.glb();
  file[4] = 1;
  EXPECT_THAT(error_of(load_scene_from_memory(file)), HasSubstr("GLB version 1"));
}

TEST(GltfJson, GarbageIsAnError) {
  EXPECT_NE(error_of(load_text("")), "");
  EXPECT_NE(error_of(load_text("{")), "");
  EXPECT_NE(error_of(load_text("null")), "");
  EXPECT_NE(error_of(load_text("[]")), "");
  EXPECT_NE(error_of(load_text({'\xff', '\xfe', '\0'})), "");
  EXPECT_THAT(error_of(load_text("{\n\n \"a\": 1,,}")), HasSubstr("at line 3, column 9"));
  EXPECT_THAT(error_of(load_text("x")), HasSubstr("at line 1, column 1"));
  EXPECT_THAT(error_of(load_text("{}")), HasSubstr("asset: is required but missing"));
  EXPECT_THAT(error_of(load_text(R"({"asset": {"version": "1.0"}})")), HasSubstr("version 1.0"));
  EXPECT_THAT(error_of(load_text(R"({"asset": {"version": "2.0"}, "x": 1e999})")),
              HasSubstr("JSON"));
}

TEST(GltfJson, DeepNestingIsAnError) {
  const std::size_t depth = 1000000;
  EXPECT_THAT(error_of(load_text(std::string(depth, '['))), HasSubstr("nested too deeply"));
  const std::string inside = R"({"asset": {"version": "2.0"}, "extras": )";
  EXPECT_THAT(error_of(load_text(inside + std::string(100, '[') + std::string(100, ']') + "}")),
              HasSubstr("nested too deeply"));
}

TEST(GltfJson, EmptyScenesLoadWithAWarning) {
  const Expected<Scene> scene = load_text(R"({"asset": {"version": "2.0"}})");
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_TRUE(world_bounds(*scene).empty());
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("no triangles")));
}

// Each: a JSON pointer, a hostile value to put there, and what the error must say.
struct Hostile {
  const char* pointer;
  Json value;
  const char* message;
};

TEST(GltfJson, HostileNumbersNameTheirPlace) {
  const Hostile cases[] = {
      {"/asset/minVersion", "2.1", "asset.minVersion: glTF version 2.1 is not supported"},
      {"/accessors/0/count", -1, "accessors[0].count: is -1"},
      {"/accessors/0/count", 0, "accessors[0].count: is 0"},
      {"/accessors/0/count", 1.5, "accessors[0].count: must be a whole number"},
      {"/accessors/0/count", 1e300, "accessors[0].count"},
      {"/accessors/0/count", 1431655765, "accessors[0]: 1431655765 elements do not fit"},
      {"/accessors/0/componentType", 5124, "accessors[0]: componentType 5124"},
      {"/accessors/0/type", "VEC5", "VEC5"},
      {"/accessors/0/bufferView", 9,
       "accessors[0].bufferView: is 9, but there are only 1 bufferViews"},
      {"/accessors/0/byteOffset", -4, "accessors[0].byteOffset: is -4"},
      {"/bufferViews/0/buffer", 1, "bufferViews[0].buffer: is 1"},
      {"/bufferViews/0/byteLength", 99, "bufferViews[0]: extends beyond the end of buffers[0]"},
      {"/bufferViews/0/byteOffset", 9007199254740991, "bufferViews[0]: extends beyond"},
      {"/bufferViews/0/byteStride", 4, "bufferViews[0].byteStride is smaller"},
      {"/buffers/0/byteLength", 4294967296, "buffers[0]: the buffer is truncated"},
      {"/meshes/0/primitives/0/mode", 7, "meshes[0].primitives[0].mode: is 7"},
      {"/meshes/0/primitives/0/attributes/POSITION", 3, "attributes.POSITION: is 3"},
      {"/meshes/0/primitives/0/attributes", "x", "attributes: must be an object"},
      {"/meshes/0/primitives/0/material", 0, "material: is 0, but there are only 0 materials"},
      {"/meshes/0/primitives/0/indices", -1, "indices: must be a whole number of 0 or more"},
      {"/meshes/0", 5, "meshes[0]: must be an object"},
      {"/meshes", Json::object(), "meshes: must be a list"},
      {"/nodes/0/mesh", 4, "nodes[0].mesh: is 4"},
      {"/nodes/0/scale", Json::array({1, 2}), "nodes[0].scale: must be a list of 3 numbers"},
      {"/nodes/0/scale", Json::array({1, 2, "x"}), "nodes[0].scale[2]: must be a number"},
      {"/nodes/0/translation", Json::array({1e39, 0, 0}),
       "nodes[0].translation[0]: is 1e+39, which is not within -3e+38 to 3e+38"},
      {"/scenes/0/nodes/0", 8, "scenes[0].nodes[0]: is 8"},
      {"/scene", 3, "scene: is 3, but there are only 1 scenes"},
  };
  for (const Hostile& hostile : cases) {
    GltfBuilder builder;
    builder.show(builder.triangle());
    builder.root["buffers"] = Json::array({{{"byteLength", 36}, {"uri", kTriangleUri}}});
    builder.root[Json::json_pointer(hostile.pointer)] = hostile.value;
    EXPECT_THAT(error_of(load_text(builder.root.dump())), HasSubstr(hostile.message))
        << hostile.pointer;
  }
}

TEST(GltfExtensions, RequiredAndUnknownIsAnErrorThatNamesIt) {
  const char* file = R"({"asset": {"version": "2.0"}, "extensionsRequired": ["EXT_from_the_future"],
      "meshes": "shaped by it"})";
  EXPECT_THAT(error_of(load_text(file)), HasSubstr("requires the extension EXT_from_the_future"));
  const char* basis =
      R"({"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_texture_basisu"]})";
  EXPECT_THAT(error_of(load_text(basis)), HasSubstr("KHR_texture_basisu"));
  EXPECT_THAT(error_of(load_text(basis)),
              HasSubstr("KTX2, which is not read; convert them to PNG"));
}

TEST(GltfExtensions, OptionalAndUnknownIsAWarning) {
  const Expected<Scene> scene = load_text(R"({"asset": {"version": "2.0"},
      "extensionsUsed": ["EXT_from_the_future", "KHR_materials_anisotropy",
                         "KHR_materials_ior"]})");
  ASSERT_TRUE(scene) << error_of(scene);
  EXPECT_THAT(scene->source.extensions, SizeIs(3));
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("EXT_from_the_future is not known")));
  EXPECT_THAT(scene->source.warnings, Contains(HasSubstr("KHR_materials_anisotropy")));
  EXPECT_THAT(scene->source.warnings, testing::Not(Contains(HasSubstr("KHR_materials_ior"))));
}

TEST(GltfExtensions, EveryKnownOneIsFound) {
  for (const gltf::Extension& extension : gltf::known_extensions()) {
    Json root = {{"asset", {{"version", "2.0"}}}, {"extensionsUsed", {extension.name}}};
    const Expected<Scene> scene = load_text(root.dump());
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_THAT(scene->source.warnings, testing::Not(Contains(HasSubstr("not known"))))
        << extension.name;
    root["extensionsRequired"] = {extension.name};
    EXPECT_EQ(load_text(root.dump()).has_value(), extension.required) << extension.name;
  }
}

}  // namespace
}  // namespace lambent::gltf_container_test
