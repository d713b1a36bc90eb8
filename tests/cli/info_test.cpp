// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace {

using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string text;
};

Outcome run_program(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen((LAMBENT_PROGRAM " " + arguments).c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 256> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.text += buffer.data();
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

// A triangle, a spot light and a camera; its mesh is named with a terminal escape.
constexpr const char* kScene = R"({
  "asset": {"version": "2.0", "generator": "by \u001b[31mhand"},
  "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_sheen"],
  "extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "spot", "name": "lamp", "intensity": 5, "spot": {}}]}},
  "buffers": [{"byteLength": 36, "uri":
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "materials": [{"name": "glow", "emissiveFactor": [1, 0.5, 0.25]}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "cameras": [{"type": "perspective", "name": "front", "perspective": {"yfov": 0.5, "znear": 0.1}}],
  "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, -2]},
    {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 4, 0]},
    {"camera": 0, "translation": [0, 0, 3]}],
  "scenes": [{"nodes": [0, 1, 2, 3]}]})";

class Info : public testing::Test {
 protected:
  Info() {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "scene.gltf") << kScene;
  }
  ~Info() override { std::filesystem::remove_all(folder_); }

  std::string file() const { return (folder_ / "scene.gltf").string(); }

  std::filesystem::path folder_;
};

TEST_F(Info, SummarizesForPeople) {
  const Outcome outcome = run_program("info " + file());
  EXPECT_EQ(outcome.status, 0);
  for (const char* part : {"scene.gltf", "KHR_lights_punctual", "2 (2 triangles)", "glow",
                           "spot 5 5 5 W/sr, at 0 4 0 m", "2 emissive triangles", "front",
                           "at 0 0 3 m", "0 0 -2 to 1 1 0 m", "KHR_materials_sheen"}) {
    EXPECT_THAT(outcome.text, HasSubstr(part));
  }
}

TEST_F(Info, LetsNoEscapeSequenceThrough) {
  EXPECT_EQ(run_program("info " + file()).text.find('\x1b'), std::string::npos);
}

TEST_F(Info, WritesOneFlatJsonObject) {
  const Outcome outcome = run_program("info --json " + file());
  EXPECT_EQ(outcome.status, 0);
  const nlohmann::json json = nlohmann::json::parse(outcome.text);
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
  const Outcome outcome = run_program("info --json cornell");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_GT(nlohmann::json::parse(outcome.text)["triangles"], 0);
}

TEST_F(Info, BadInputIsStatusTwoAndNamesFileAndCause) {
  const Outcome missing = run_program("info " + (folder_ / "none.glb").string() + " 2>&1");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.text, HasSubstr("none.glb: no such file"));
  std::ofstream(folder_ / "scene.gltf") << R"({"asset": {"version": "2.0"}, "scene": 3})";
  const Outcome broken = run_program("info " + file() + " 2>&1");
  EXPECT_EQ(broken.status, 2);
  EXPECT_THAT(broken.text, HasSubstr("scene: is 3, but there are only 0 scenes"));
  EXPECT_EQ(run_program("info 2>&1").status, 2);
  EXPECT_EQ(run_program("info --verbose " + file() + " 2>&1").status, 2);
}

}  // namespace
