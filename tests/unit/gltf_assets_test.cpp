// SPDX-License-Identifier: Apache-2.0
// Real files, where a developer has them; and the fuzzer's corpus, always.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/files/file_bytes.h"
#include "fuzz/gltf_input.h"
#include "scene/gltf/import.h"
#include "scene/texture.h"
#include "unit/gltf_builder.h"

namespace lambent::gltf_assets_test {
namespace {

using test::error_of;

const std::string kScenes = std::string(LAMBENT_SHARED_DIR) + "/scenes/";

struct Row {
  std::string file;
  std::size_t triangles = 0;
};

// The table of the scenes' README: file in the first column, triangles in the second.
std::vector<Row> listed_scenes() {
  std::vector<Row> rows;
  std::ifstream readme(kScenes + "README.md");
  for (std::string line; std::getline(readme, line);) {
    std::istringstream cells(line);
    std::string bar, file, separator;
    Row row;
    if (!(cells >> bar >> file >> separator >> row.triangles) || bar != "|") continue;
    if (file.find(".gl") == std::string::npos) continue;
    row.file = file;
    rows.push_back(row);
  }
  return rows;
}

// How many slivers without area the importer says it has dropped.
std::size_t dropped_triangles(const Scene& scene) {
  std::size_t count = 0;
  for (const std::string& warning : scene.source.warnings) {
    if (warning.find("triangles without area") != std::string::npos) count += std::stoul(warning);
  }
  return count;
}

// Where the table counts otherwise than triangles over all instances: it lists one instance of the
// instanced box, of the primitive modes only the mode of separate triangles, and of spheres the
// triangles without area at their poles.
const std::map<std::string, std::size_t> kCountedOtherwise = {
    {"khronos/SimpleInstancing/glTF-Binary/SimpleInstancing.glb", 125 * 12},
    {"khronos/MeshPrimitiveModes/glTF/MeshPrimitiveModes.gltf", 16},
    {"khronos/MetalRoughSpheresNoTextures/glTF-Binary/MetalRoughSpheresNoTextures.glb", 1040213},
};

TEST(Assets, ImportAndHaveTheirTriangles) {
  const std::vector<Row> rows = listed_scenes();
  if (rows.empty()) GTEST_SKIP() << "no scenes in " << kScenes;
  for (const Row& row : rows) {
    const Expected<Scene> scene = load_scene(kScenes + row.file);
    ASSERT_TRUE(scene) << error_of(scene);
    EXPECT_EQ(error_of(validate(*scene)), "");
    const auto otherwise = kCountedOtherwise.find(row.file);
    const std::size_t expected =
        otherwise == kCountedOtherwise.end() ? row.triangles : otherwise->second;
    EXPECT_EQ(triangle_count(*scene) + dropped_triangles(*scene), expected) << row.file;
  }
}

Scene load_or_fail(const std::string& file) {
  Expected<Scene> scene = load_scene(kScenes + file);
  EXPECT_TRUE(scene) << error_of(scene);
  return scene ? std::move(*scene) : Scene{};
}

// The triangles' centres in object space: which corner comes first does not matter.
std::vector<glm::vec3> centres_of(const Mesh& mesh) {
  std::vector<glm::vec3> centres;
  for (const glm::uvec3& t : mesh.triangles) {
    centres.push_back((mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0f);
  }
  return centres;
}

TEST(Assets, MeshoptGivesTheSameGeometry) {
  if (!std::filesystem::exists(kScenes + "hotel_room")) GTEST_SKIP() << "no hotel_room";
  // The compressed file lacks the node that scales the plain one to metres: compare object space
  const Scene plain = load_or_fail("hotel_room/hotel_room.glb");
  const Scene compressed = load_or_fail("hotel_room/hotel_meshopt.glb");
  ASSERT_EQ(plain.meshes.size(), compressed.meshes.size());
  Bounds bounds;
  float largest = 0.0f;
  for (std::size_t i = 0; i < plain.meshes.size(); ++i) {
    const auto expected = centres_of(plain.meshes[i]);
    const auto actual = centres_of(compressed.meshes[i]);
    ASSERT_EQ(expected.size(), actual.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      largest = std::max(largest, glm::length(expected[k] - actual[k]));
    }
    for (const glm::vec3& position : plain.meshes[i].positions) bounds.add(position);
  }
  // Floats are stored with 15 bits of mantissa or more
  EXPECT_LT(largest, glm::length(bounds.max - bounds.min) / 32768.0f);
}

TEST(Assets, DracoGivesTheSameGeometry) {
  if (!std::filesystem::exists(kScenes + "khronos/Duck")) GTEST_SKIP() << "no khronos/Duck";
  for (const char* name : {"Duck", "CesiumMan", "RiggedSimple", "CesiumMilkTruck", "Box"}) {
    const std::string folder = std::string("khronos/") + name;
    const Scene plain = load_or_fail(folder + "/glTF-Binary/" + name + ".glb");
    const Scene draco = load_or_fail(folder + "/glTF-Draco/" + name + ".gltf");
    EXPECT_EQ(triangle_count(plain), triangle_count(draco)) << name;
    const Bounds a = world_bounds(plain);
    const Bounds b = world_bounds(draco);
    const float tolerance = glm::length(a.max - a.min) / 1000.0f;
    EXPECT_LT(glm::length(a.min - b.min), tolerance) << name;
    EXPECT_LT(glm::length(a.max - b.max), tolerance) << name;
  }
}

TEST(Assets, TextureTransformTestPointsItsArrowsAtTheCorrectMarkers) {
  const std::string file = "khronos/TextureTransformTest/glTF/TextureTransformTest.gltf";
  if (!std::filesystem::exists(kScenes + file)) GTEST_SKIP() << "no " << file;
  const Scene scene = load_or_fail(file);
  const Material* material = nullptr;
  for (const Material& candidate : scene.materials) {
    if (candidate.name == "Rotation") material = &candidate;
  }
  ASSERT_NE(material, nullptr);
  // The image's arrow lies on its diagonal; turned right, it lies between the quad's corner and the
  // green marker, whose place in the quad is (0.42095, 1.01627), and not towards the red one's
  TextureView plain = material->base_color_texture;
  plain.uv_rotation = 0.0f;
  const glm::vec2 green(0.42095f, 1.01627f);
  const glm::vec2 red(1.01627f, 0.42095f);
  constexpr float kAlongTheArrow = 0.7f;
  const glm::vec2 diagonal(0.77782f, 0.77782f);
  const glm::vec4 arrow = sample_texture(scene, plain, kAlongTheArrow * diagonal);
  const TextureView& turned = material->base_color_texture;
  EXPECT_LT(glm::length(sample_texture(scene, turned, kAlongTheArrow * green) - arrow), 0.05f);
  EXPECT_GT(glm::length(sample_texture(scene, turned, kAlongTheArrow * red) - arrow), 0.05f);
}

TEST(Assets, AnimatedOnesStayValidAndStartInTheirRestPose) {
  for (const char* file :
       {"AnimatedCube/glTF/AnimatedCube.gltf", "BoxAnimated/glTF-Binary/BoxAnimated.glb",
        "CesiumMan/glTF-Binary/CesiumMan.glb", "Fox/glTF-Binary/Fox.glb",
        "InterpolationTest/glTF-Binary/InterpolationTest.glb",
        "RiggedSimple/glTF-Binary/RiggedSimple.glb", "SimpleSkin/glTF/SimpleSkin.gltf"}) {
    const std::string path = std::string(LAMBENT_SHARED_DIR) + "/scenes/khronos/" + file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    Expected<Scene> scene = load_scene(path);
    ASSERT_TRUE(scene) << error_of(scene);
    ASSERT_FALSE(scene->animations.empty()) << file;
    // Without its curves an animation leaves everything at rest
    const Scene rest = *scene;
    Scene still = rest;
    still.animations.insert(still.animations.begin(), Animation{});
    animate(still, 0, 0.3f);
    const Bounds a = world_bounds(still), b = world_bounds(rest);
    const float size = glm::length(b.max - b.min);
    EXPECT_LT(glm::distance(a.min, b.min), 1e-5f * size) << file;
    EXPECT_LT(glm::distance(a.max, b.max), 1e-5f * size) << file;

    const float end = duration(scene->animations[0]);
    EXPECT_GT(end, 0.5f) << file;
    for (const float share : {0.0f, 0.37f, 1.0f}) {
      animate(*scene, 0, share * end);
      EXPECT_EQ(error_of(validate(*scene)), "") << file;
    }
  }
}

TEST(Assets, FuzzCorpusNeverCrashesAndImportsToValidScenes) {
  const std::filesystem::path corpus = std::filesystem::path(LAMBENT_FUZZ_CORPUS) / "gltf";
  ASSERT_TRUE(std::filesystem::is_directory(corpus));
  int imported = 0;
  for (const auto& file : std::filesystem::directory_iterator(corpus)) {
    const auto bytes = read_file(file.path().string());
    ASSERT_TRUE(bytes) << error_of(bytes);
    const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes->data());
    Expected<Scene> scene =
        load_scene_from_memory(test::gltf_from_fuzz_input({begin, bytes->size()}));
    if (!scene) {
      EXPECT_FALSE(scene.error().cause.empty()) << file.path();
      continue;
    }
    ++imported;
    EXPECT_EQ(error_of(validate(*scene)), "") << file.path();
    if (file.path().stem() == "animation") {
      EXPECT_TRUE(scene->source.warnings.empty());
      EXPECT_EQ(scene->animations.at(0).channels.size(), 7u);
    }
    for (const float time_s : {0.0f, 0.5f, 1e30f}) {
      animate(*scene, -1, time_s);
      EXPECT_EQ(error_of(validate(*scene)), "") << file.path() << " at " << time_s << " s";
    }
  }
  EXPECT_GT(imported, 0);
}

}  // namespace
}  // namespace lambent::gltf_assets_test
