// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lambent/image.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::render_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// The cheapest picture that is one.
const std::string kQuick = " --size 32x18 --samples 1 --probes 4x4x4 --rays 32 --updates 2 ";

/// The last line that is not empty: what scripts show to people.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t start = text.rfind('\n');
  return start == std::string::npos ? text : text.substr(start + 1);
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Render : public ::testing::Test {
 protected:
  ProgramResult render(const std::string& arguments, const std::string& output) const {
    return run_program("render " + arguments + " -o " + output);
  }
  test::TemporaryDirectory directory;
  std::string exr = directory.file("out.exr"), png = directory.file("out.png");
};

TEST_F(Render, EveryMethodWritesEveryKindOfPicture) {
  for (const std::string method : {"field", "direct", "reference"}) {
    for (const std::string& output : {exr, png}) {
      const std::string field = method == "field" ? kQuick : " --size 32x18 --samples 2 ";
      const ProgramResult result = render("cornell --method " + method + field, output);
      ASSERT_EQ(result.status, 0) << method << ": " << result.errors;
      const auto image = read_image(output);
      ASSERT_TRUE(image) << image.error().message();
      EXPECT_EQ(image->width, 32);
      EXPECT_EQ(image->height, 18);
      const std::vector<float>& pixels = image->layers[0].image.pixels;
      EXPECT_GT(*std::max_element(pixels.begin(), pixels.end()), 0.0f) << method;
      EXPECT_EQ(image->layers.size(), 1u);
    }
  }
  EXPECT_EQ(directory.entries(), 2u);
}

TEST_F(Render, WritesTheLayersThatTheDocumentsPromise) {
  for (const std::string method : {"field", "reference"}) {
    const std::string field = method == "field" ? kQuick : " --size 32x18 --samples 2 ";
    ASSERT_EQ(render("cornell --layers --method " + method + field, exr).status, 0);
    const auto image = read_image(exr);
    ASSERT_TRUE(image) << image.error().message();
    for (const char* name : {"", "direct", "indirect", "irradiance", "glossy", "transmission",
                             "emission", "albedo", "normal", "position", "depth"}) {
      const Image* layer = image->find(name);
      ASSERT_NE(layer, nullptr) << method << ": " << name;
      EXPECT_EQ(layer->channels, std::string(name) == "depth" ? 1 : 3);
    }
    // The whole is the sum of its parts
    const auto at = [&](const char* name, std::size_t i) { return image->find(name)->pixels[i]; };
    for (std::size_t i = 0; i < image->find("")->pixels.size(); ++i) {
      EXPECT_NEAR(at("", i),
                  at("direct", i) + at("indirect", i) + at("glossy", i) + at("transmission", i) +
                      at("emission", i),
                  1e-4f * (1.0f + at("", i)));
    }
  }
}

TEST_F(Render, StatisticsAreAFlatObjectWithUnitsInItsKeys) {
  const std::string stats = directory.file("stats.json");
  ASSERT_EQ(render("cornell" + kQuick + "--stats " + stats, exr).status, 0);
  const auto json = nlohmann::json::parse(bytes_of(stats));
  for (const auto& [key, value] : json.items()) EXPECT_FALSE(value.is_structured()) << key;
  for (const char* key : {"build_ms", "trace_ms", "shade_ms", "solve_ms", "store_ms", "gbuffer_ms",
                          "direct_ms", "indirect_ms", "compose_ms"}) {
    ASSERT_TRUE(json.contains(key)) << key;
    EXPECT_GE(json[key].get<double>(), 0.0) << key;
  }
  EXPECT_EQ(json["method"], "field");
  EXPECT_EQ(json["width"], 32);
  EXPECT_EQ(json["height"], 18);
  EXPECT_EQ(json["updates"], 2);
  EXPECT_EQ(json["probes"], 64);
  EXPECT_EQ(json["rays_per_probe"], 32);
  // Most probes are in the scene's open space, and are traced in both updates
  EXPECT_GT(json["probe_rays"], 32 * 64 / 2);
  EXPECT_LE(json["probe_rays"], 2 * 64 * 32);
  EXPECT_LE(json["bytes_per_probe"].get<double>(), 1168.0);
  EXPECT_GT(json["triangles"].get<int>(), 0);
}

TEST_F(Render, VerifyPrintsTheErrorOfEachLayer) {
  const ProgramResult result = render("cornell" + kQuick + "--verify 8", exr);
  ASSERT_EQ(result.status, 0) << result.errors;
  for (const char* word : {"8 path-traced samples", "all", "direct", "indirect", "irradiance",
                           "mean ratio", "relative RMSE"}) {
    EXPECT_THAT(result.output, HasSubstr(word));
  }
}

TEST_F(Render, SameArgumentsGiveTheSameBytesOnAnyNumberOfThreads) {
  const std::string other = directory.file("other.exr");
  for (const std::string method : {"field", "direct", "reference"}) {
    const std::string field = method == "field" ? " --probes 4x4x4 --rays 32" : "";
    const std::string arguments =
        "cornell --size 48x32 --samples 2 --layers --method " + method + field;
    ASSERT_EQ(render(arguments + " --seed 5 --threads 1", exr).status, 0);
    ASSERT_EQ(render(arguments + " --seed 5 --threads 4", other).status, 0);
    EXPECT_TRUE(bytes_of(exr) == bytes_of(other)) << method;
    ASSERT_EQ(render(arguments + " --seed 6", other).status, 0);
    EXPECT_FALSE(bytes_of(exr) == bytes_of(other)) << method;
  }
}

TEST_F(Render, CamerasAreChosenByNameAndIndex) {
  EXPECT_EQ(render("atrium --camera 1 --method direct --size 16x9 --samples 1", exr).status, 0);
  EXPECT_EQ(render("two-rooms --camera roomB --method direct --size 16x9", exr).status, 0);
  EXPECT_EQ(
      render("cornell --eye 2,2,2 --target 3,3,3 --fov 60 --method direct --size 16x9", exr).status,
      0);
}

TEST_F(Render, ConvergesAndTellsHowMuchTheLastUpdateChanged) {
  const std::string stats = directory.file("stats.json");
  const ProgramResult result =
      render("cornell --size 8x8 --probes 3x3x3 --rays 64 --converge --stats " + stats, exr);
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto json = nlohmann::json::parse(bytes_of(stats));
  EXPECT_GT(json["updates"].get<int>(), 2);
  EXPECT_LT(json["field_change_last_update"].get<double>(), 0.01);
}

// Few rays leave noise: a picture of high quality has more updates, until the light is calm.
TEST_F(Render, UpdatesTheFieldUntilItIsCalmWhereQualityIsHigh) {
  const std::string stats = directory.file("stats.json");
  const auto updates_of = [&](const std::string& options) {
    const std::string picture = "two-rooms --size 8x8 --probes 4x4x4 --rays 16 --gather 0 ";
    EXPECT_EQ(render(picture + options + " --stats " + stats, exr).status, 0);
    return nlohmann::json::parse(bytes_of(stats));
  };
  const auto high = updates_of("--quality high");
  EXPECT_GT(high["updates"], 8);
  EXPECT_LE(high["updates"], 80);
  EXPECT_TRUE(high["updates"] == 80 || high["field_standard_error"] < 0.025);
  EXPECT_EQ(updates_of("--quality draft")["updates"], 8);
  EXPECT_EQ(updates_of("--quality high --updates 3")["updates"], 3);
}

TEST_F(Render, TracesHalfOfTheRaysAfterTheFirstUpdatesOfAPicture) {
  const std::string stats = directory.file("stats.json");
  const auto rays_of = [&](const std::string& options) {
    const std::string picture = "cornell-spot --size 8x8 --probes 4x4x4 --rays 16 --gather 0 ";
    EXPECT_EQ(render(picture + options + " --stats " + stats, exr).status, 0);
    return nlohmann::json::parse(bytes_of(stats))["probe_rays"].get<double>();
  };
  // Of 80 updates three are full. The others trace half as many rays, or fewer: whole probes
  const double full = rays_of("--updates 3") / 3.0, all = rays_of("--quality high") / full;
  EXPECT_LE(all, 3.0 + 77.0 * 0.5);
  EXPECT_GT(all, 3.0 + 77.0 * 0.45);
}

TEST_F(Render, TellsHowMuchNoiseIsLeftInTheField) {
  const std::string scene = "cornell-spot --size 8x8 --probes 3x3x3 ",
                    picture = scene + "--gather 0 ";
  EXPECT_THAT(render(picture + "--rays 16", exr).errors,
              ContainsRegex("probes still has [0-9]+ % of noise after 80 updates"));
  EXPECT_THAT(render(scene + "--rays 16 --gather 1", exr).errors, Not(HasSubstr("noise")));
  EXPECT_THAT(render(picture, exr).errors, Not(HasSubstr("noise")));
}

TEST_F(Render, TellsThatAPictureIsBlack) {
  const std::string rooms = "two-rooms-sealed --method direct --size 8x8 --camera ";
  for (const std::string& file : {png, exr}) {
    EXPECT_THAT(render(rooms + "roomB", file).errors, HasSubstr("the picture is black"));
    EXPECT_THAT(render(rooms + "roomA", file).errors, Not(HasSubstr("black")));
  }
}

struct BadUse {
  const char* name;
  const char* arguments;
  const char* word;  // of the last line on stderr
};

class BadRender : public ::testing::TestWithParam<BadUse> {};

TEST_P(BadRender, IsStatusTwoWithACauseAndLeavesNoFile) {
  const test::TemporaryDirectory directory;
  const std::string output = directory.file("out.exr");
  const ProgramResult result =
      run_program(std::string("render ") + GetParam().arguments + " -o " + output);
  EXPECT_EQ(result.status, 2) << result.errors;
  const std::string line = last_line(result.errors);
  EXPECT_EQ(line.rfind("lambent: ", 0), 0u) << result.errors;
  EXPECT_THAT(line, HasSubstr(GetParam().word));
  EXPECT_EQ(directory.entries(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Arguments, BadRender,
    ::testing::Values(
        BadUse{"no_scene", "", "SCENE"}, BadUse{"unknown_flag", "cornell --quality 9", "--quality"},
        BadUse{"unknown_method", "cornell --method rsm2", "--method"},
        BadUse{"unknown_backend", "cornell --backend cuda", "--backend"},
        BadUse{"device_without_vulkan", "cornell --device 0", "--device"},
        BadUse{"validation_without_vulkan", "cornell --vulkan-validation", "--vulkan-validation"},
        BadUse{"reference_on_vulkan", "cornell --backend vulkan --method reference", "--backend"},
        BadUse{"reference_most_samples", "cornell --method reference --most-samples 4",
               "--most-samples"},
        BadUse{"missing_scene", "nowhere.glb", "nowhere.glb"},
        BadUse{"scene_that_is_no_scene", "/dev/null", "/dev/null"},
        BadUse{"size_of_zero", "cornell --size 0x10", "--size"},
        BadUse{"size_without_height", "cornell --size 640", "--size"},
        BadUse{"negative_size", "cornell --size=-4x4", "--size"},
        BadUse{"huge_size", "cornell --size 99999x99999", "--size"},
        BadUse{"size_with_a_tail", "cornell --size 64x64x", "--size"},
        BadUse{"eye_without_target", "cornell --eye 1,2,3", "--target"},
        BadUse{"target_without_eye", "cornell --target 1,2,3", "--eye"},
        BadUse{"eye_is_target", "cornell --eye 1,2,3 --target 1,2,3", "--target"},
        BadUse{"eye_that_is_no_point", "cornell --eye 1,2 --target 1,2,3", "--eye"},
        BadUse{"eye_that_is_infinite", "cornell --eye 1,inf,3 --target 1,2,3", "--eye"},
        BadUse{"camera_and_eye", "cornell --camera 0 --eye 1,2,3 --target 0,0,0", "--camera"},
        BadUse{"unknown_camera", "two-rooms --camera attic", "roomB"},
        BadUse{"camera_beyond_the_last", "two-rooms --camera 99", "roomB"},
        BadUse{"updates_and_converge", "cornell --updates 3 --converge", "--converge"},
        BadUse{"no_updates", "cornell --updates 0", "--updates"},
        BadUse{"converge_without_field", "cornell --method direct --converge", "--converge"},
        BadUse{"bounces_without_any", "cornell --method direct --bounces 2", "--bounces"},
        BadUse{"negative_bounces", "cornell --bounces=-1", "--bounces"},
        BadUse{"probes_and_spacing", "cornell --probes 4x4x4 --probe-spacing 1", "--probe"},
        BadUse{"one_probe", "cornell --probes 1x1x1", "--probes"},
        BadUse{"huge_probes", "cornell --probes 4096x4096x4096", "probes"},
        BadUse{"too_many_probes", "cornell --probes 200x200x200", "probes"},
        BadUse{"zero_spacing", "cornell --probe-spacing 0", "--probe-spacing"},
        BadUse{"negative_spacing", "cornell --probe-spacing=-1", "--probe-spacing"},
        BadUse{"spacing_next_to_nothing", "cornell --probe-spacing 1e-20", "spacing"},
        BadUse{"spacing_not_a_number", "cornell --probe-spacing nan", "spacing"},
        BadUse{"few_rays", "cornell --rays 3", "--rays"},
        BadUse{"many_rays", "cornell --rays 100000", "--rays"},
        BadUse{"full_hysteresis", "cornell --hysteresis 1", "--hysteresis"},
        BadUse{"odd_tile", "cornell --irradiance-texels 5", "--irradiance-texels"},
        BadUse{"unknown_format", "cornell --irradiance-format rgb8", "--irradiance-format"},
        BadUse{"bounds_inside_out", "cornell --bounds 1,1,1,0,0,0", "--bounds"},
        BadUse{"volume_inside_out", "cornell --volume 1,1,1,0,0,0", "--volume"},
        BadUse{"volume_without_a_meaning", "cornell --volume 0,0,0,1,1,1:spacing", "spacing"},
        BadUse{"volume_turned_by_nothing", "cornell --volume 0,0,0,1,1,1:turn=nan", "turn"},
        BadUse{"volume_far_away", "cornell --volume 90,0,0,91,1,1", "outside the scene"},
        BadUse{"bounds_far_away", "cornell --bounds 90,0,0,91,1,1", "outside the scene"},
        BadUse{"volume_of_too_many_probes", "cornell --volume 0,0,0,1,1,1:spacing=0.001",
               "more than"},
        BadUse{"too_many_cascades", "cornell --cascades 17", "--cascades"},
        BadUse{"cascades_in_a_box", "cornell --cascades 2 --bounds 0,0,0,1,1,1", "--bounds"},
        BadUse{"cascades_beyond_numbers", "cornell --cascades 16 --probe-spacing 1e38", "spacing"},
        BadUse{"cascades_and_maps", "cornell --method rsm+field --cascades 2", "--cascades"},
        BadUse{"eye_beyond_numbers", "cornell --eye 1e20,0,0 --target 0,0,0", "1e9"},
        BadUse{"thin_cascades", "cornell --cascades 2 --probes 8x3x8", "at least 4"},
        BadUse{"sun_without_direction", "cornell --sun 0,0,0", "--sun"},
        BadUse{"irradiance_without_sun", "cornell --sun-irradiance 1,1,1", "--sun"},
        BadUse{"negative_sky", "cornell --sky=-1,0,0", "--sky"},
        BadUse{"sky_and_environment", "cornell --sky 1,1,1 --environment nowhere.hdr",
               "either --sky or --environment"},
        BadUse{"missing_environment", "cornell --environment nowhere.hdr", "nowhere.hdr"},
        BadUse{"no_threads", "cornell --threads 0", "--threads"},
        BadUse{"samples_not_a_number", "cornell --samples many", "--samples"},
        BadUse{"field_of_view_of_180", "cornell --eye 1,2,3 --target 0,0,0 --fov 180", "--fov"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(Render, OutputsThatCannotBeWrittenFailBeforeAnyWork) {
  const std::string large = "cornell --size 4096x4096 --samples 1024";
  for (const std::string& output : {directory.file("picture.gif"), directory.file("none")}) {
    const ProgramResult result = render(large, output);
    EXPECT_EQ(result.status, 2) << output;
    EXPECT_THAT(last_line(result.errors), HasSubstr(output));
  }
  for (const std::string& arguments :
       {large + " -o /dev/null/all.exr", large + " --stats /dev/null/all.json -o " + exr}) {
    const ProgramResult result = run_program("render " + arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_THAT(last_line(result.errors), HasSubstr("/dev/null/all."));
  }
  const ProgramResult layers = render("cornell --layers", png);
  EXPECT_EQ(layers.status, 2);
  EXPECT_THAT(last_line(layers.errors), HasSubstr("--layers"));
  const ProgramResult exposure = render("cornell --exposure bright" + kQuick, png);
  EXPECT_EQ(exposure.status, 2);
  EXPECT_THAT(last_line(exposure.errors), HasSubstr("--exposure"));
  EXPECT_EQ(directory.entries(), 0u);
}

TEST_F(Render, AFailureLeavesTheOldPictureAlone) {
  std::ofstream(exr) << "mine";
  EXPECT_EQ(render("nowhere.glb", exr).status, 2);
  EXPECT_EQ(bytes_of(exr), "mine");
  EXPECT_EQ(directory.entries(), 1u);
}

}  // namespace
}  // namespace lambent::render_test
