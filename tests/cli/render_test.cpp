// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent {
namespace {

using ::testing::HasSubstr;
using testing::run_program;

// The smallest picture of the smallest scene: what is tested is the program, not the light.
const std::string kQuick = " furnace --size 8x4 --samples 1 --updates 1 --probes 2x2x2 --rays 16 ";

class Render : public ::testing::Test {
 protected:
  testing::TemporaryDirectory directory;
  std::string exr = directory.file("out.exr");
};

TEST_F(Render, WritesLayersAndStatistics) {
  const std::string stats = directory.file("stats.json");
  const auto result = run_program("render" + kQuick + "--layers --stats " + stats + " -o " + exr);
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto image = read_image(exr);
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image->width, 8);
  EXPECT_EQ(image->height, 4);
  for (const char* layer : {"", "direct", "indirect", "irradiance", "emission", "albedo", "normal",
                            "position", "depth"}) {
    EXPECT_NE(image->find(layer), nullptr) << layer;
  }
  const auto json = nlohmann::json::parse(std::ifstream(stats));
  EXPECT_EQ(json.at("probes"), 8);
  EXPECT_EQ(json.at("updates"), 1);
  EXPECT_GT(json.at("acceleration_structure_bytes"), 0);
}

TEST_F(Render, GivesTheSamePictureOnAnyNumberOfThreads) {
  const std::string other = directory.file("other.exr");
  ASSERT_EQ(run_program("render" + kQuick + "--threads 1 -o " + exr).status, 0);
  ASSERT_EQ(run_program("render" + kQuick + "--threads 3 -o " + other).status, 0);
  const auto a = read_image(exr), b = read_image(other);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->find("")->pixels, b->find("")->pixels);
}

TEST_F(Render, FieldOfViewReplacesThatOfTheCamera) {
  const std::string other = directory.file("other.exr");
  const std::string direct = "render furnace --size 8x4 --samples 1 --method direct --layers -o ";
  ASSERT_EQ(run_program(direct + exr).status, 0);
  ASSERT_EQ(run_program(direct + other + " --fov 20").status, 0);
  const auto a = read_image(exr), b = read_image(other);
  ASSERT_TRUE(a && b);
  EXPECT_NE(a->find("position")->pixels, b->find("position")->pixels);
  const auto parallel =
      run_program("render squares-parallel --size 8x4 --method direct --fov 20 -o " + exr);
  EXPECT_EQ(parallel.status, 2);
  EXPECT_THAT(parallel.errors, HasSubstr("orthographic"));
}

TEST_F(Render, BadUsageIsStatus2WithAMessageAndNoOutput) {
  const std::string start = "render cornell -o " + exr + " ";
  const std::pair<std::string, std::string> cases[] = {
      {"render none.glb -o " + exr, "none.glb: no such file"},
      {"render cornell -o " + directory.file("out.jpg"), "must end in .exr or .png"},
      {"render cornell -o " + directory.file("none/out.exr"), "cannot write"},
      {"render cornell --layers -o " + directory.file("out.png"), "--layers"},
      {start + "--size 0x4", "--size"},
      {start + "--size 99999999x1", "--size"},
      {start + "--sun 0,0,0", "--sun"},
      {start + "--sun nan,0,1", "--sun"},
      {start + "--sky -1,0,0", "--sky"},
      {start + "--sun-irradiance 1,1,1", "needs --sun"},
      {start + "--eye 0,0,0", "--eye and --target"},
      {start + "--camera nobody", "no camera 'nobody'"},
      {start + "--probes 1x1x1", "--probes"},
      {start + "--probes 4x4x4 --probe-spacing 1", "--probes"},
      {start + "--volume 0,0,0,0,0,0", "--volume"},
      {start + "--exposure bright", "--exposure"},
      {start + "--method direct --probes 4x4x4", "--probes: goes with --method field alone"},
      {start + "--method reference --gather 4", "--gather: goes with --method field alone"},
      {start + "--backend abacus", "abacus"},
      {start + "--frobnicate", "frobnicate"},
  };
  for (const auto& [arguments, message] : cases) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr(message)) << arguments;
    EXPECT_EQ(directory.entries(), 0u) << arguments;
  }
}

}  // namespace
}  // namespace lambent
