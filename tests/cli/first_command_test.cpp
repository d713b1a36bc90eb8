// SPDX-License-Identifier: Apache-2.0
// `lambent SCENE`, where pictures go, and what is said of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::first_command_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

const std::string kDirect = " --method direct --samples 1 --size 16x9 ";

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class FirstCommand : public ::testing::Test {
 protected:
  /// Runs the program in the test's own folder.
  ProgramResult run_there(const std::string& arguments) const {
    // The shell goes there first; the program's path is absolute
    return run_program("--version >/dev/null && cd " + directory.path().string() +
                       " && " LAMBENT_PROGRAM " " + arguments);
  }
  bool exists(const std::string& name) const {
    return std::filesystem::exists(directory.file(name));
  }
  test::TemporaryDirectory directory;
};

TEST_F(FirstCommand, OfABuiltInSceneIsAPictureHere) {
  const ProgramResult result = run_there("cornell" + kDirect);
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_TRUE(exists("cornell.png"));
  EXPECT_EQ(directory.entries(), 1u);
  EXPECT_EQ(result.output, "");
}

TEST_F(FirstCommand, OfAFileIsAPictureBesideIt) {
  std::filesystem::create_directories(directory.file("scenes"));
  ASSERT_EQ(run_there("make-scene cube -o scenes/my.cube.glb").status, 0);
  const std::string before = bytes_of(directory.file("scenes/my.cube.glb"));
  ASSERT_EQ(run_there("scenes/my.cube.glb" + kDirect).status, 0);
  EXPECT_TRUE(exists("scenes/my.cube.png"));
  EXPECT_EQ(bytes_of(directory.file("scenes/my.cube.glb")), before);
  EXPECT_EQ(directory.entries(), 1u);
}

TEST_F(FirstCommand, IsThatOfRenderWhateverComesFirst) {
  ASSERT_EQ(run_there("cornell -o a.exr" + kDirect).status, 0);
  ASSERT_EQ(run_there("render cornell -o b.exr" + kDirect).status, 0);
  ASSERT_EQ(run_there("--quiet" + kDirect + "-o c.exr cornell").status, 0);
  EXPECT_EQ(bytes_of(directory.file("a.exr")), bytes_of(directory.file("b.exr")));
  EXPECT_EQ(bytes_of(directory.file("a.exr")), bytes_of(directory.file("c.exr")));
  ASSERT_EQ(run_there("render cornell" + kDirect).status, 0);
  EXPECT_TRUE(exists("cornell.png"));
  ASSERT_EQ(run_there("cornell --frames 2" + kDirect).status, 0);
  EXPECT_TRUE(exists("cornell.0001.png"));
}

TEST_F(FirstCommand, NeverWritesOverTheSceneOrItsTextures) {
  ASSERT_EQ(run_there("make-scene cube -o scene.glb").status, 0);
  std::filesystem::rename(directory.file("scene.glb"), directory.file("scene.png"));
  const std::string before = bytes_of(directory.file("scene.png"));
  const ProgramResult result = run_there("render scene.png" + kDirect);
  EXPECT_EQ(result.status, 2) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("scene.png"));
  EXPECT_EQ(bytes_of(directory.file("scene.png")), before);

  std::ofstream(directory.file("box.gltf"))
      << R"({"asset": {"version": "2.0"}, "images": [{"uri": "box.png"}]})";
  std::ofstream(directory.file("box.png")) << "a texture";
  EXPECT_EQ(run_there("box.gltf" + kDirect).status, 2);
  EXPECT_EQ(bytes_of(directory.file("box.png")), "a texture");
}

TEST_F(FirstCommand, PassesOverCamerasOfTheSceneThatSeeNothing) {
  // A triangle around the origin; cameras at z = 3 look at it unless they are turned about
  const auto write = [this](const std::string& name, const std::string& cameras) {
    std::ofstream(directory.file(name)) << R"({"asset": {"version": "2.0"}, "scene": 0,
      "scenes": [{"nodes": [0, 1, 2]}], "nodes": [{"mesh": 0}, )"
                                        << cameras << R"(],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]})";
  };
  const float triangle[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  std::ofstream(directory.file("triangle.bin"), std::ios::binary)
      .write(reinterpret_cast<const char*>(triangle), sizeof triangle);
  const std::string away = R"({"name": "away", "camera": 0, "translation": [0, 0, 3],
                               "rotation": [0, 1, 0, 0]})";
  const std::string towards = R"({"name": "towards", "camera": 0, "translation": [0, 0, 3]})";

  write("one.gltf", away + ", " + towards);
  const ProgramResult one = run_there("one.gltf -o one.exr" + kDirect);
  ASSERT_EQ(one.status, 0) << one.errors;
  EXPECT_THAT(one.errors, HasSubstr("camera: the scene's 'towards'"));
  write("none.gltf", away + ", " + away);
  const ProgramResult none = run_there("none.gltf -o none.exr" + kDirect);
  ASSERT_EQ(none.status, 0) << none.errors;
  EXPECT_THAT(none.errors, HasSubstr("No camera of the scene sees any of its surfaces"));
  EXPECT_THAT(none.errors, HasSubstr("camera: the whole object"));
  const ProgramResult asked = run_there("none.gltf --camera 0 -o asked.exr" + kDirect);
  ASSERT_EQ(asked.status, 0) << asked.errors;
  EXPECT_THAT(asked.errors, HasSubstr("camera: the scene's 'away'"));
  const ProgramResult narrow = run_there("one.gltf --fov 20 -o narrow.exr" + kDirect);
  ASSERT_EQ(narrow.status, 0) << narrow.errors;
  EXPECT_NE(bytes_of(directory.file("narrow.exr")), bytes_of(directory.file("one.exr")));
}

TEST_F(FirstCommand, MakesFoldersThatAreMissing) {
  ASSERT_EQ(run_there("cornell -o new/of/a.png --stats other/s.json" + kDirect).status, 0);
  EXPECT_TRUE(exists("new/of/a.png"));
  EXPECT_TRUE(exists("other/s.json"));
  ASSERT_EQ(run_there("cornell --frames 2 -o f####/a.png" + kDirect).status, 0);
  EXPECT_TRUE(exists("f0000/a.png"));
  EXPECT_TRUE(exists("f0001/a.png"));
  ASSERT_EQ(run_there("make-scene cube -o made/cube.glb").status, 0);
  ASSERT_EQ(run_there("prepare cube -o prepared/cube").status, 0);
  ASSERT_EQ(run_there("bake cornell --probes 2x2x2 --updates 1 -o baked/a.field").status, 0);
  ASSERT_EQ(run_there("field export baked/a.field -o atlas/a").status, 0);
  ASSERT_EQ(run_there("picture atlas/a.irradiance.exr -o shown/a.png").status, 0);
  ASSERT_EQ(run_there("compare shown/a.png shown/a.png --heatmap heat/a.png").status, 0);
  EXPECT_TRUE(exists("heat/a.png"));
}

TEST_F(FirstCommand, LeavesNoFolderBehindWhereItFails) {
  EXPECT_EQ(run_there("nowhere.glb -o new/a.png").status, 2);
  EXPECT_EQ(run_there("cornell --sun 0,0,0 -o new/a.png").status, 2);
  EXPECT_EQ(directory.entries(), 0u);
}

TEST_F(FirstCommand, FailsWhereNothingCanBeWritten) {
  std::ofstream(directory.file("file")) << "mine";
  for (const std::string arguments :
       {"cornell -o file/a.png", "cornell -o a.png --stats file/new/s.json",
        "make-scene cube -o file/a.glb", "prepare cube -o file/a", "bake cornell -o file/a.field",
        "cornell -o /proc/a.png"}) {
    const ProgramResult result = run_there(arguments);
    EXPECT_EQ(result.status, 1) << arguments << "\n" << result.errors;
    EXPECT_THAT(result.errors, HasSubstr("cannot ")) << arguments;
  }
  EXPECT_EQ(directory.entries(), 1u);
}

TEST_F(FirstCommand, SaysWhatWasWritten) {
  const ProgramResult png = run_there("cornell -o a.png --exposure=1.5" + kDirect);
  EXPECT_THAT(png.errors, HasSubstr("lambent: wrote a.png: 16x9 pixels, "));
  EXPECT_THAT(png.errors, HasSubstr(" s; exposure +1.50 stops"));
  const std::string size =
      std::to_string(std::filesystem::file_size(directory.file("a.png"))) + " bytes, in ";
  EXPECT_THAT(png.errors, HasSubstr(size));
  const ProgramResult frames = run_there("cornell -o b.exr --frames 3" + kDirect);
  EXPECT_THAT(frames.errors, HasSubstr("wrote 3 files, b.0000.exr to b.0002.exr: 16x9 pixels, "));
  EXPECT_EQ(png.output + frames.output, "");
}

TEST_F(FirstCommand, QuietIsSilentForEverySubcommand) {
  for (const std::string& arguments :
       {"cornell -o a.exr" + kDirect, std::string("make-scene cube -o cube.glb"),
        std::string("prepare cube -o cube"), std::string("field export a.field -o atlas"),
        std::string("cornell --method reference --samples 1 --size 8x8"),
        std::string("picture a.exr -o a.png"), "cube.glb" + kDirect,
        "cornell --sky 1,1,1 --size 8x8 --samples 1 --updates 0 --field " +
            std::string("a.field")}) {
    if (!exists("a.field")) {
      const ProgramResult baked =
          run_there("bake cornell --quiet --probes 2x2x2 --updates 1 -o a.field");
      EXPECT_EQ(baked.errors + baked.output, "");
    }
    const ProgramResult told = run_there(arguments), quiet = run_there(arguments + " --quiet");
    EXPECT_EQ(quiet.status, 0) << arguments << "\n" << told.errors;
    EXPECT_EQ(quiet.errors, "") << arguments;
    EXPECT_THAT(told.errors, HasSubstr("lambent: wrote ")) << arguments;
    EXPECT_EQ(told.output, "") << arguments;
  }
  const ProgramResult wrong = run_there("nowhere.glb --quiet");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("nowhere.glb"));
}

TEST_F(FirstCommand, WritesJpegsThatShowThePicture) {
  ASSERT_EQ(run_there("cornell -o a.png --size 64x48 --method direct --samples 1").status, 0);
  for (const std::string name : {"a.jpg", "b.JPEG"}) {
    ASSERT_EQ(run_there("cornell --size 64x48 --method direct --samples 1 -o " + name).status, 0);
    EXPECT_EQ(bytes_of(directory.file(name)).substr(0, 2), "\xff\xd8");
    const auto ours = read_image(directory.file(name)), exact = read_image(directory.file("a.png"));
    ASSERT_TRUE(ours && exact);
    ASSERT_EQ(ours->width, 64);
    double error = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < exact->layers[0].image.pixels.size(); ++i) {
      const float truth = exact->layers[0].image.pixels[i];
      error += std::abs(ours->layers[0].image.pixels[i] - truth);
      mean += truth;
    }
    EXPECT_LT(error, 0.1 * mean);  // one sample a pixel is noise, which JPEG blurs
  }
}

TEST_F(FirstCommand, KnowsUsualSizesByName) {
  ASSERT_EQ(run_there("squares-parallel --method direct --samples 1 --size 480p").status, 0);
  const auto image = read_image(directory.file("squares-parallel.png"));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 854);
  EXPECT_EQ(image->height, 480);
}

}  // namespace
}  // namespace lambent::first_command_test
