// SPDX-License-Identifier: Apache-2.0
// What the program says to those who mistype, ask for help, or hand it the wrong file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::words_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;
using ::testing::Not;

struct Mistake {
  const char* name;
  const char* arguments;
  const char* said;
};

class Mistyped : public ::testing::TestWithParam<Mistake> {};

TEST_P(Mistyped, IsAnsweredWithWhatWasMeant) {
  const ProgramResult result = run_program(GetParam().arguments);
  EXPECT_EQ(result.status, 2) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(GetParam().said));
  EXPECT_EQ(result.output, "");
  // One line, that of ours
  EXPECT_EQ(result.errors.rfind("lambent: ", 0), 0u) << result.errors;
  EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
}

INSTANTIATE_TEST_SUITE_P(
    Words, Mistyped,
    ::testing::Values(
        Mistake{"subcommand", "rendr cornell", "did you mean 'render'?"},
        Mistake{"subcommand_of_field", "field inf a.field", "did you mean 'info'?"},
        Mistake{"no_subcommand_of_field", "field", "a subcommand is missing: info or export"},
        Mistake{"scene_alone", "cornel", "did you mean 'cornell'?"},
        Mistake{"scene", "render cornel", "did you mean 'cornell'?"},
        Mistake{"scene_to_make", "make-scene two-room -o a.glb", "did you mean 'two-rooms'?"},
        Mistake{"nothing_near", "frobnicate", "neither a subcommand nor a scene (see"},
        Mistake{"view", "view cornell", "'view' is not part of this version yet"},
        Mistake{"flag", "render cornell --probs 3", "unknown option '--probs'; did you mean"},
        Mistake{"flag_before_the_scene", "bake --probs 3x3x3 cornell -o f", "'--probes'?"},
        Mistake{"flag_with_a_value", "cornell --sise=64x64", "'--sise'; did you mean '--size'?"},
        Mistake{"flag_that_is_nothing", "cornell --frobnicate",
                "unknown option '--frobnicate' (see lambent render --help)"},
        Mistake{"argument_too_many", "info cornell cube", "unexpected argument 'cube'"},
        Mistake{"method", "render cornell --method feild", "did you mean 'field'?"},
        Mistake{"backend", "render cornell --backend vulcan", "did you mean 'vulkan'?"},
        Mistake{"tone_map", "render cornell --tone-map aecs", "did you mean 'aces'?"},
        Mistake{"visibility", "render cornell --visibility exat",
                "--visibility: 'exat' is not one of exact, hybrid and moments; did you mean"},
        Mistake{"pattern", "render cornell --method rsm --rsm-pattern dsik", "'disk'?"},
        Mistake{"format", "render cornell --distance-format rg16", "did you mean 'rg16f'?"},
        Mistake{"size", "render cornell --size 1080", "did you mean '1080p'?"},
        Mistake{"camera", "render cornell --camera 9", "the scene has 1 camera: 0 '"},
        Mistake{"camera_name", "render two-rooms --camera rooomB", "did you mean 'roomB'?"},
        Mistake{"animation", "render atrium --time 1 --animation dor", "did you mean 'door'?"},
        Mistake{"no_output", "bake cornell", "-o FILE is missing (see lambent bake --help)"},
        Mistake{"no_scene", "render", "SCENE is missing (see lambent render --help)"},
        Mistake{"no_value", "render cornell --size", "--size: needs a value, WxH"},
        Mistake{"given_three_times", "render cornell --size 1x1 --size 2x2 --size 3x3",
                "--size: was given 3 times, and goes once"},
        Mistake{"radius", "cornell --method rsm --rsm-pattern disk --rsm-radius 0",
                "--rsm-radius: 0 is not above 0, up to 2"},
        Mistake{"softening", "cornell --method rsm --rsm-softening 0.001",
                "--rsm-softening: 0.001 is not between 0.01 and 100"},
        Mistake{"odd_tile", "cornell --quiet --size 8x8 --irradiance-texels 5",
                "--irradiance-texels: must"},
        Mistake{"spacing", "cornell --quiet --size 8x8 --probe-spacing 1e-14",
                "--probe-spacing: is so"},
        Mistake{"bounds", "cornell --quiet --size 8x8 --bounds 90,0,0,91,1,1",
                "--bounds: lies outside"},
        Mistake{"volume", "cornell --quiet --size 8x8 --volume 90,0,0,91,1,1",
                "--volume 90,0,0,91,1,1: l"},
        Mistake{"frame_updates", "cornell --frame-updates 2",
                "--frame-updates: goes with --frames"}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// Options whose value is a number that is not whole.
class NotANumber : public ::testing::TestWithParam<const char*> {};

TEST_P(NotANumber, IsRefusedByTheOptionsName) {
  const std::string option = GetParam();
  const bool compares = option == "--scale";
  const std::string command = compares ? "compare a.exr b.exr " : "render atrium --frames 2 ";
  for (const std::string value : {"nan", "inf", "-inf", "1e999", "2x", "''"}) {
    const ProgramResult result = run_program(command + option + "=" + value);
    EXPECT_EQ(result.status, 2) << value;
    EXPECT_THAT(result.errors, HasSubstr("lambent: " + option + ": ")) << value;
  }
}

INSTANTIATE_TEST_SUITE_P(Options, NotANumber,
                         ::testing::Values("--time-budget", "--fps", "--fov", "--time",
                                           "--hysteresis", "--probe-spacing", "--rsm-radius",
                                           "--rsm-softening", "--exposure", "--scale", "--sun",
                                           "--samples", "--rays", "--ray-budget"),
                         [](const auto& tested) {
                           std::string name(tested.param);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name.substr(2);
                         });

class Files : public ::testing::Test {
 protected:
  std::string said(const std::string& arguments, int status = 2) const {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.errors;
    return result.errors;
  }
  test::TemporaryDirectory directory;
};

TEST_F(Files, OfTheWrongKindAreNamedForWhatTheyAre) {
  const std::string image = directory.file("u.exr"), field = directory.file("a.field");
  ASSERT_TRUE(write_exr(image, {2, 2, {{"", Image(2, 2, 3)}}}));
  ASSERT_TRUE(write_png(directory.file("u.png"), Image(2, 2, 3)));
  ASSERT_EQ(run_program("bake cornell --probes 2x2x2 --updates 1 -o " + field).status, 0);
  const std::string glb = directory.file("cube.glb");
  ASSERT_EQ(run_program("make-scene cube -o " + glb).status, 0);
  EXPECT_THAT(said("info " + image), HasSubstr("u.exr: is an OpenEXR image, not a glTF scene; "
                                               "lambent picture"));
  EXPECT_THAT(said("render " + directory.file("u.png")), HasSubstr("is a PNG image"));
  EXPECT_THAT(said("info " + field), HasSubstr("is a field of lambent bake, not a glTF scene"));
  EXPECT_THAT(said("compare " + glb + " " + image), HasSubstr("is a binary glTF scene, not an"));
  EXPECT_THAT(said("picture " + glb + " -o " + directory.file("a.png")),
              HasSubstr("lambent render and lambent info read scenes"));
  EXPECT_THAT(said("field info " + image), HasSubstr("is an OpenEXR image, not a field"));
  EXPECT_THAT(said("render cornell --environment " + field), HasSubstr("not an image"));
  std::ofstream(directory.file("a.obj")) << "v 0 0 0\n";
  EXPECT_THAT(said("info " + directory.file("a.obj")),
              HasSubstr("is a Wavefront OBJ scene, not a glTF scene: convert it to glTF"));
  std::ofstream(directory.file("none.glb")) << "";
  EXPECT_THAT(said("info " + directory.file("none.glb")), HasSubstr("is an empty file"));
  std::ofstream(directory.file("text.glb")) << "hello";
  EXPECT_THAT(said("info " + directory.file("text.glb")), HasSubstr("is not a glTF scene"));
  std::ofstream(directory.file("broken.gltf")) << "{\n  \"asset\": {,\n";
  const std::string broken = said("info " + directory.file("broken.gltf"));
  EXPECT_THAT(broken, HasSubstr("line 2, column 13"));
  EXPECT_THAT(broken, Not(HasSubstr("json.exception")));
}

TEST_F(Files, ThatAreMissingAreAnsweredWithTheNearestBesideThem) {
  std::ofstream(directory.file("cornell.glb")) << "x";
  EXPECT_THAT(said("render " + directory.file("Cornel.glb")),
              HasSubstr("no such file; did you mean 'cornell.glb'?"));
  EXPECT_THAT(said("compare " + directory.file("cornell.gbl") + " b.exr"),
              HasSubstr("did you mean 'cornell.glb'?"));
  EXPECT_THAT(said(directory.file("no/a.glb")), HasSubstr("there is no folder"));
  EXPECT_THAT(said("info " + directory.path().string()),
              HasSubstr("is a folder, not a file; it has cornell.glb"));
}

TEST_F(Files, OfOurOwnMayNotBeCalledPicturesOrScenes) {
  EXPECT_THAT(said("bake cornell -o " + directory.file("c.png")), HasSubstr("may not end in .png"));
  EXPECT_THAT(said("bake cornell -o " + directory.file("c.glb")), HasSubstr("may not end in .glb"));
  EXPECT_THAT(said("prepare cornell -o " + directory.file("c.GLB")), HasSubstr("a prepared scene"));
  EXPECT_EQ(directory.entries(), 0u);
}

TEST_F(Files, LayersThatAreMissingAreAnsweredWithTheNearest) {
  const std::string image = directory.file("u.exr");
  ASSERT_TRUE(write_exr(image, {2, 2, {{"", Image(2, 2, 3)}, {"indirect", Image(2, 2, 3)}}}));
  const std::string picture = "picture " + image + " -o " + directory.file("a.png");
  EXPECT_THAT(said(picture + " --layer indrect"),
              HasSubstr("which has (picture) and indirect; did you mean 'indirect'?"));
  EXPECT_THAT(said("compare --layer indirct " + image + " " + image),
              HasSubstr("did you mean 'indirect'?"));
}

TEST(Help, OfNothingIsShortAndAnError) {
  const ProgramResult result = run_program("");
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_THAT(result.errors, HasSubstr("lambent scene.glb"));
  EXPECT_THAT(result.errors, HasSubstr("lambent --help"));
}

TEST(Help, OfRenderBeginsWithFiveOptionsAndThreeExamples) {
  const ProgramResult result = run_program("render --help");
  ASSERT_EQ(result.status, 0) << result.errors;
  const std::string& help = result.output;
  EXPECT_THAT(help, HasSubstr("\n  --no-relocation  "));
  const std::size_t most_used = help.find("Most used:"), examples = help.find("Examples:");
  ASSERT_LT(most_used, examples);
  ASSERT_NE(examples, std::string::npos);
  const auto count = [](const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
      ++found;
    }
    return found;
  };
  EXPECT_EQ(count(help.substr(most_used, examples - most_used), "\n  -"), 5u);
  const std::size_t rest = help.find(":\n", examples + std::string("Examples:").size());
  EXPECT_EQ(count(help.substr(examples, rest - examples), "\n  lambent render "), 3u);
  for (const char* group : {"Where to look from:", "The field:", "Motion:", "Reflective shadow"}) {
    EXPECT_GT(help.find(group), examples) << group;
    EXPECT_THAT(help, HasSubstr(group));
  }
  // No name of CLI11's stands for a value
  for (const char* type : {" TEXT", " INT", " FLOAT", " UINT"})
    EXPECT_THAT(help, Not(HasSubstr(type)));
}

TEST(Help, IsThereForEverySubcommandInLinesThatFit) {
  for (const std::string command :
       {"", "render", "picture", "compare", "info", "scenes", "make-scene", "prepare", "bake",
        "field", "field info", "field export", "devices"}) {
    const ProgramResult result = run_program(command + " --help");
    EXPECT_EQ(result.status, 0) << command;
    EXPECT_THAT(result.output, HasSubstr("Usage: lambent")) << command;
    EXPECT_THAT(result.output, HasSubstr("--quiet")) << command;
    for (std::size_t at = 0; at < result.output.size();) {
      const std::size_t end = std::min(result.output.find('\n', at), result.output.size());
      EXPECT_LE(end - at, 100u) << result.output.substr(at, end - at);
      at = end + 1;
    }
    EXPECT_EQ(run_program("help " + command).output, result.output) << command;
  }
}

TEST(Help, OfWhatIsNoSubcommandIsAnError) {
  const ProgramResult result = run_program("help rendr");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("'rendr' is no subcommand"));
  EXPECT_THAT(result.errors, HasSubstr("did you mean 'render'"));
}

TEST(Options, FilesHaveNames) {
  for (const std::string command : {"render cornell", "bake cornell", "make-scene cornell"}) {
    const ProgramResult result = run_program(command + " -o ''");
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(result.errors, HasSubstr("the name of a file")) << command;
  }
}

TEST(Scenes, AreListedForPeopleAndForPrograms) {
  const ProgramResult table = run_program("scenes"), json = run_program("scenes --json");
  ASSERT_EQ(table.status, 0) << table.errors;
  ASSERT_EQ(json.status, 0) << json.errors;
  const auto listed = nlohmann::json::parse(json.output);
  const auto count = listed.at("scenes").get<std::size_t>();
  EXPECT_GE(count, 11u);
  for (const char* list : {"names", "descriptions", "triangles", "cameras", "animations"}) {
    EXPECT_EQ(listed.at(list).size(), count) << list;
  }
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_THAT(table.output, HasSubstr(listed["names"][i].get<std::string>()));
    EXPECT_THAT(table.output, HasSubstr(listed["descriptions"][i].get<std::string>()));
    EXPECT_GT(listed["triangles"][i].get<int>(), 0);
  }
  EXPECT_EQ(listed["names"][0], "cornell");
  EXPECT_EQ(listed["triangles"][0], 38);
  EXPECT_EQ(listed["animations"].back(), 2);  // the atrium's sun and door
}

TEST(StandardOutput, ThatIsFullIsAFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const test::TemporaryDirectory directory;
  const std::string image = directory.file("u.exr"), field = directory.file("a.field");
  ASSERT_TRUE(write_exr(image, {16, 16, {{"", Image(16, 16, 3)}}}));
  ASSERT_EQ(run_program("bake cornell --probes 2x2x2 --updates 1 -o " + field).status, 0);
  for (const std::string& arguments :
       {std::string("info cornell"), std::string("info --json cornell"), std::string("scenes"),
        std::string("--help"), std::string("--version"), "compare " + image + " " + image,
        "field info " + field}) {
    const ProgramResult result = run_program(arguments + " >/dev/full");
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_THAT(result.errors, HasSubstr("standard output: cannot write")) << arguments;
  }
}

}  // namespace
}  // namespace lambent::words_test
