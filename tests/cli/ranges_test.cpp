// SPDX-License-Identifier: Apache-2.0
// Numbers from outside that no formula could stand: told apart from others before any arithmetic.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <utility>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::ranges_test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;
using test::ProgramResult;
using test::run_program;

// Two triangles in the plane z = 0, two metres wide.
constexpr const char* kScene =
    R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,)"
    R"(AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgD8AAAAA"}],
  "bufferViews": [{"buffer": 0, "byteLength": 48}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}],
  "materials": [{"name": "wall"}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 6, "material": 0}]}],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
  "nodes": [{"mesh": 0},
    {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 1]}],
  "scenes": [{"nodes": [0, 1]}]})";

class Ranges : public ::testing::Test {
 protected:
  /// Writes the scene with one member replaced.
  std::string scene_with(const char* pointer, const Json& value) const {
    Json root = Json::parse(kScene);
    if (*pointer != '\0') root[Json::json_pointer(pointer)] = value;
    std::ofstream(file) << root.dump();
    return file;
  }
  ProgramResult render(const std::string& arguments) const {
    return run_program("render " + arguments +
                       " --size 32x18 --samples 1 --probes 4x4x4 --rays 32 --updates 2"
                       " --eye 0.1,0.2,3 --target 0,0,0 -o " +
                       picture);
  }
  void expect_refused(const ProgramResult& result, const std::string& words) const {
    EXPECT_EQ(result.status, 2) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(words));
    EXPECT_FALSE(read_image(picture)) << words;
  }
  void expect_finite_picture(const ProgramResult& result) const {
    ASSERT_EQ(result.status, 0) << result.errors;
    const auto image = read_image(picture);
    ASSERT_TRUE(image) << image.error().message();
    double sum = 0.0;
    for (const float value : image->layers[0].image.pixels) {
      ASSERT_TRUE(std::isfinite(value)) << result.errors;
      sum += value;
    }
    EXPECT_GT(sum, 0.0);
  }

  test::TemporaryDirectory directory;
  std::string picture = directory.file("out.exr"), file = directory.file("scene.gltf");
};

TEST_F(Ranges, OptionsOutsideThemNameThemselves) {
  const std::pair<const char*, const char*> cases[] = {
      {"--fov=nan", "--fov"},
      {"--bounds=0,0,0,1e20,1e20,1e20", "--bounds"},
      {"--bounds=0,0,0,nan,1,1", "--bounds"},
      {"--volume=0,0,0,1e20,1e20,1e20", "--volume"},
      {"--sky=1e30,1,1", "--sky"},
      {"--sky=nan,1,1", "--sky"},
      {"--sun=0,-1,0 --sun-irradiance=1e30,1,1", "--sun-irradiance"},
      {"--sun=0,nan,0", "--sun"},
  };
  for (const auto& [option, words] : cases) {
    expect_refused(render(scene_with("", {}) + " " + option), words);
  }
  // A direction may have any length
  expect_finite_picture(render(scene_with("", {}) + " --sun=1e-3,1e38,-3e38"));
}

TEST_F(Ranges, ScenesOutsideThemNameThePlace) {
  const std::tuple<const char*, Json, const char*> cases[] = {
      {"/nodes/0/translation", {1e19, 0, 0}, "nodes[0]: the mesh reaches beyond 1e9 m"},
      {"/nodes/1/translation", {0, 1e19, 0}, "nodes[1]: the light is beyond 1e9 m"},
      {"/nodes/0/scale", {1e20, 1, 1}, "nodes[0]: the mesh is scaled by more than 1e10"},
      {"/scenes/0/nodes", Json::array({1}), "has no triangles"},
      {"/nodes/0/scale", {1, 0, 0}, "has no triangles"},
  };
  for (const auto& [pointer, value, words] : cases) {
    expect_refused(render(scene_with(pointer, value)), words);
  }
  // What cannot be rendered can still be described
  EXPECT_EQ(run_program("info " + scene_with("/scenes/0/nodes", Json::array({1}))).status, 0);
}

TEST_F(Ranges, AbsurdLightsAreReducedAndLeaveNoPixelWithoutANumber) {
  const std::pair<const char*, Json> cases[] = {
      {"/extensions/KHR_lights_punctual/lights/0/intensity", 1e30},
      {"/extensions/KHR_lights_punctual/lights/0/intensity", 3e38},
      {"/materials/0", Json::parse(R"({"emissiveFactor": [1, 1, 1], "extensions": {
        "KHR_materials_emissive_strength": {"emissiveStrength": 1e38}}})")},
  };
  for (const auto& [pointer, value] : cases) {
    for (const std::string method : {"field", "rsm+field"}) {
      const ProgramResult result =
          render(scene_with(pointer, value) + " --method " + method + " --sky 1,1,1");
      EXPECT_THAT(result.errors, HasSubstr("reduced to 1e1")) << pointer;
      expect_finite_picture(result);
    }
  }
}

TEST_F(Ranges, FlatThingsAreDrawn) {
  const ProgramResult result = render(scene_with("/nodes/0/scale", {1, 1, 0}));
  expect_finite_picture(result);
  EXPECT_EQ(result.errors.find("left out"), std::string::npos) << result.errors;
}

TEST_F(Ranges, MissingTexturesAreAWarning) {
  Json root = Json::parse(kScene);
  root["images"] = Json::parse(R"([{"uri": "none.png"}])");
  root["textures"] = Json::parse(R"([{"source": 0}])");
  root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  std::ofstream(file) << root.dump();
  const ProgramResult result = render(file);
  expect_finite_picture(result);
  EXPECT_THAT(result.errors, HasSubstr("none.png): no such file, in material 'wall'"));
}

}  // namespace
}  // namespace lambent::ranges_test
