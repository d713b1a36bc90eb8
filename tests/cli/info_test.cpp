// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::info_test {
namespace {

using test::ProgramResult;
using test::run_program;
using testing::HasSubstr;

// A triangle, a spot light and a camera; its mesh is named with a terminal escape.
constexpr const char* kScene = R"({
  "asset": {"version": "2.0", "generator": "by \u001b[31mhand"},
  "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_anisotropy"],
  "extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "spot", "name": "lamp", "intensity": 5, "spot": {}}]}},
  "buffers": [{"byteLength": 36, "uri":
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "materials": [{"name": "glow", "emissiveFactor": [1, 0.5, 0.25],
    "extensions": {"KHR_materials_ior": {"ior": 1.33}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "cameras": [{"type": "perspective", "name": "front", "perspective": {"yfov": 0.5, "znear": 0.1}}],
  "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, -2]},
    {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 4, 0]},
    {"camera": 0, "translation": [0, 0, 3]}],
  "scenes": [{"nodes": [0, 1, 2, 3]}]})";

class Info : public testing::Test {
 protected:
  Info() { std::ofstream(file()) << kScene; }

  std::string file() const { return folder.file("scene.gltf"); }

  lambent::test::TemporaryDirectory folder;
};

TEST_F(Info, SummarizesForPeople) {
  const ProgramResult outcome = run_program("info " + file());
  EXPECT_EQ(outcome.status, 0);
  for (const char* part :
       {"scene.gltf", "KHR_lights_punctual", "2 (2 triangles)", "glow",
        "spot 5 5 5 W/sr, at 0 4 0 m", "2 emissive triangles", "front", "ior 1.33", "at 0 0 3 m",
        "0 0 -2 to 1 1 0 m", "KHR_materials_anisotropy"}) {
    EXPECT_THAT(outcome.output, HasSubstr(part));
  }
}

TEST_F(Info, LetsNoEscapeSequenceThrough) {
  EXPECT_EQ(run_program("info " + file()).output.find('\x1b'), std::string::npos);
}

TEST_F(Info, WritesOneFlatJsonObject) {
  const ProgramResult outcome = run_program("info --json " + file());
  EXPECT_EQ(outcome.status, 0);
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  ASSERT_TRUE(json.is_object());
  for (const auto& [key, value] : json.items()) EXPECT_FALSE(value.is_object()) << key;
  EXPECT_EQ(json["meshes"], 1);
  EXPECT_EQ(json["instances"], 2);
  EXPECT_EQ(json["triangles"], 2);
  EXPECT_EQ(json["emissive_triangles"], 2);
  EXPECT_EQ(json["light_types"], nlohmann::json({"spot"}));
  EXPECT_EQ(json["camera_names"], nlohmann::json({"front"}));
  EXPECT_EQ(json["bounds_max_m"], nlohmann::json({1.0, 1.0, 0.0}));
  EXPECT_EQ(json["warnings"].size(), 1u);
}

TEST_F(Info, KnowsBuiltInScenes) {
  const ProgramResult outcome = run_program("info --json cornell");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_GT(nlohmann::json::parse(outcome.output)["triangles"], 0);
}

TEST_F(Info, BadInputIsStatusTwoAndNamesFileAndCause) {
  const ProgramResult missing = run_program("info " + folder.file("none.glb"));
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.errors, HasSubstr("none.glb: no such file"));
  std::ofstream(file()) << R"({"asset": {"version": "2.0"}, "scene": 3})";
  const ProgramResult broken = run_program("info " + file());
  EXPECT_EQ(broken.status, 2);
  EXPECT_THAT(broken.errors, HasSubstr("scene: is 3, but there are only 0 scenes"));
  EXPECT_EQ(run_program("info").status, 2);
  EXPECT_EQ(run_program("info --verbose " + file()).status, 2);
}

}  // namespace
}  // namespace lambent::info_test
