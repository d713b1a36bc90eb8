// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "core/image/metrics.h"
#include "lambent/image.h"
#include "scenes/glb_writer.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::render_sequence_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kQuick = " --size 24x16 --samples 1 --probes 4x4x4 --rays 32 --updates 3 ";

nlohmann::json json_of(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

double mean_of(const std::string& path) {
  const auto image = read_image(path);
  EXPECT_TRUE(image) << path;
  double sum = 0.0;
  for (const float v : image->layers[0].image.pixels) sum += v;
  return sum / static_cast<double>(image->layers[0].image.pixels.size());
}

class RenderSequence : public ::testing::Test {
 protected:
  test::TemporaryDirectory directory;
};

TEST_F(RenderSequence, WritesAPictureAFrameAndStatisticsOfEach) {
  const std::string stats = directory.file("stats.json");
  const ProgramResult result = run_program("render atrium --frames 3 --fps 0.25 --stats " + stats +
                                           kQuick + "-o " + directory.file("out.exr"));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(directory.entries(), 4u);
  const auto json = json_of(stats);
  EXPECT_EQ(json["fps"], 0.25);
  ASSERT_EQ(json["frames"].size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const auto& frame = json["frames"][i];
    EXPECT_EQ(frame["frame"], i);
    EXPECT_NEAR(frame["time_s"].get<double>(), 4.0 * i, 1e-6);
    EXPECT_EQ(frame["updates"], i == 0 ? 3 : 1);
    EXPECT_EQ(frame["moved_boxes"], i == 0 ? 0 : 4);
    EXPECT_EQ(frame["changed_lights"], i == 0 ? 0 : 1);
    for (const char* key : {"trace_ms", "store_ms", "gbuffer_ms", "world_update_ms"}) {
      EXPECT_GE(frame[key].get<double>(), 0.0) << key;
    }
  }
  // The sun goes on
  const double first = mean_of(directory.file("out.0000.exr"));
  const double last = mean_of(directory.file("out.0002.exr"));
  EXPECT_GT(std::abs(last / first - 1.0), 0.02);
}

TEST_F(RenderSequence, PutsTheNumberWhereThePatternAsksForIt) {
  const ProgramResult result =
      run_program("render cornell --method direct --size 8x8 --samples 1 --frames 2 -o " +
                  directory.file("a####b.png"));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_TRUE(std::filesystem::exists(directory.file("a0000b.png")));
  EXPECT_TRUE(std::filesystem::exists(directory.file("a0001b.png")));
  EXPECT_EQ(directory.entries(), 2u);
}

TEST_F(RenderSequence, StartsAtTheTimeThatIsAskedFor) {
  const std::string one = directory.file("one.exr"), many = directory.file("many.exr");
  const std::string direct =
      "render atrium --method direct --quality draft --size 24x16 --samples 1 --time 9 ";
  ASSERT_EQ(run_program(direct + "-o " + one).status, 0);
  ASSERT_EQ(run_program(direct + "--frames 1 --without taa -o " + many).status, 0);
  EXPECT_EQ(mean_of(one), mean_of(directory.file("many.0000.exr")));
  ASSERT_EQ(run_program("render atrium --method direct --size 24x16 --samples 1 -o " + one).status,
            0);
  EXPECT_NE(mean_of(one), mean_of(directory.file("many.0000.exr")));
}

TEST_F(RenderSequence, PlaysTheAnimationThatIsChosen) {
  const std::string stats = directory.file("stats.json");
  for (const std::string name : {"door", "1"}) {
    ASSERT_EQ(run_program("render atrium --method direct --size 8x8 --samples 1 --frames 2 --fps 1 "
                          "--animation " +
                          name + " --stats " + stats + " -o " + directory.file("out.exr"))
                  .status,
              0);
    const auto frame = json_of(stats)["frames"][1];
    EXPECT_EQ(frame["moved_boxes"], name == "door" ? 4 : 0);
    EXPECT_EQ(frame["changed_lights"], name == "door" ? 0 : 1);
  }
}

TEST_F(RenderSequence, OfAFileIsThatOfTheBuiltInScene) {
  const std::string glb = directory.file("atrium.glb");
  ASSERT_EQ(run_program("make-scene atrium -o " + glb).status, 0);
  const std::string direct = " --method direct --size 32x24 --samples 1 --time 9 -o ";
  ASSERT_EQ(run_program("render " + glb + direct + directory.file("a.exr")).status, 0);
  ASSERT_EQ(run_program("render atrium" + direct + directory.file("b.exr")).status, 0);
  const double ours = mean_of(directory.file("a.exr")), theirs = mean_of(directory.file("b.exr"));
  EXPECT_NEAR(ours / theirs, 1.0, 0.01);
}

// A garage whose door rises by 3 m in a second, seen from inside, in the sun that the file brings.
TEST_F(RenderSequence, HasTheSkyThatAnOpenDoorShows) {
  using test::box_mesh;
  Scene scene = test::scene_of(
      {box_mesh({-3, 0, -3}, {3, 3, -2.8f}), box_mesh({-3, 0, -3}, {-2.8f, 3, 3}),
       box_mesh({2.8f, 0, -3}, {3, 3, 3}), box_mesh({-3, 2.8f, -3}, {3, 3, 3}),
       box_mesh({-20, -1, -20}, {20, 0, 20}), box_mesh({-3.1f, -0.1f, 3}, {3.1f, 3, 3.2f})});
  scene.lights.push_back(test::sun(glm::vec3(5.0f), {0, -1, -1}));
  scene.cameras.push_back(look_at({0, 1.5f, -2.5f}, {0, 1.5f, 0}, 1.0f));
  scenes::Track door;
  door.index = 5;
  door.keyframes = {{0.0f, {}, {1, 0, 0, 0}}, {1.0f, {0, 3, 0}, {1, 0, 0, 0}}};
  ASSERT_TRUE(scenes::write_glb(scene, directory.file("a.glb"), {{"opens", {door}}}));
  const std::string quick = "render " + directory.file("a.glb") + kQuick + "-o ";
  const ProgramResult still = run_program(quick + directory.file("a.png"));
  EXPECT_THAT(still.errors, HasSubstr("black sky")) << "the shut door shows no sky";
  const ProgramResult opens = run_program(quick + directory.file("a.png") + " --frames 2 --fps 1");
  EXPECT_THAT(opens.errors, HasSubstr("under a sky in proportion to its suns"));
}

// A case of 6 cm that is shut in its first frame; its lid rises by 9 cm and turns upright.
TEST_F(RenderSequence, ShowsACaseThatOpensFromOutsideInAllFrames) {
  using test::quad;
  Scene scene = test::scene_of({quad({0, 0, 0}, {0, 0, 0.06f}, {0.09f, 0, 0}, 0),
                                quad({0, 0, 0}, {0.09f, 0, 0}, {0, 0.06f, 0}, 0),
                                quad({0.09f, 0, 0.06f}, {-0.09f, 0, 0}, {0, 0.06f, 0}, 0),
                                quad({0, 0, 0.06f}, {0, 0, -0.06f}, {0, 0.06f, 0}, 0),
                                quad({0.09f, 0, 0}, {0, 0, 0.06f}, {0, 0.06f, 0}, 0),
                                quad({0, 0.06f, 0}, {0.09f, 0, 0}, {0, 0, 0.06f}, 0)});
  scenes::Track lid;
  lid.index = 5;
  lid.keyframes = {{0.0f, {}, {1, 0, 0, 0}},
                   {1.0f, {0, 0.09f, 0}, {0.7071068f, -0.7071068f, 0, 0}}};
  ASSERT_TRUE(scenes::write_glb(scene, directory.file("a.glb"), {{"opens", {lid}}}));
  const std::string quick = "render " + directory.file("a.glb") +
                            " --method direct --size 48x27 --samples 1 -o " +
                            directory.file("a.png");
  const ProgramResult still = run_program(quick + " --time 0");
  const ProgramResult sequence = run_program(quick + " --frames 3 --fps 2");
  const auto camera_of = [](const ProgramResult& result) {
    const std::size_t at = result.errors.find("camera: the whole object");
    return at == std::string::npos ? ""
                                   : result.errors.substr(at, result.errors.find('\n', at) - at);
  };
  EXPECT_NE(camera_of(still), "") << still.errors;
  EXPECT_NE(camera_of(sequence), "") << sequence.errors;
  EXPECT_NE(camera_of(sequence), camera_of(still)) << "the risen lid needs more of the frame";
}

// A lift that climbs 8 m in a second, in a shaft of 2 x 2 x 12 m with one open side on grounds of
// 400 m; after 0.15 s, its sun is 2,000 times as strong as before.
TEST_F(RenderSequence, OfALiftAtDawnIsExposedAndLitForAllOfItsWay) {
  const std::string scene = LAMBENT_TEST_DATA "/lift_at_dawn.gltf";
  const std::string quick =
      " --size 24x16 --samples 1 --rays 32 --updates 2 --frames 5 --fps 4 -o ";
  ProgramResult result = run_program("render " + scene + quick + directory.file("out.png"));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("finer ones along the camera's path"));
  EXPECT_THAT(result.errors, HasSubstr("exposure: the median"));
  // Neither white nor black
  const double last = mean_of(directory.file("out.0004.png"));
  EXPECT_GT(last, 0.05);
  EXPECT_LT(last, 0.9);

  // Files of radiance need no exposure, and the sky that was added follows the sun
  result = run_program("render " + scene + " --size 24x16 --samples 1 --rays 32 --updates 2 " +
                       "--frames 2 --time 0.14 --fps 50 -o " + directory.file("out.exr"));
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, Not(HasSubstr("exposure")));
  const double dark = mean_of(directory.file("out.0000.exr")),
               bright = mean_of(directory.file("out.0001.exr"));
  EXPECT_NEAR(bright / dark, 2000.0, 200.0);
}

TEST_F(RenderSequence, StopsAfterAFrameWhenInterrupted) {
  const std::string stats = directory.file("stats.json");
  const std::string pattern = directory.file("f.exr");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    execl(LAMBENT_PROGRAM, LAMBENT_PROGRAM, "render", "cornell", "--method", "direct", "--size",
          "64x64", "--frames", "1000000", "--stats", stats.c_str(), "-o", pattern.c_str(),
          static_cast<char*>(nullptr));
    _exit(127);
  }
  while (!std::filesystem::exists(directory.file("f.0001.exr"))) {
    // A child that ended before it wrote a second frame never will
    ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  // Every picture that is there is whole, and nothing else is there
  const std::size_t frames = json_of(stats)["frames"].size();
  EXPECT_EQ(directory.entries(), frames + 1);
  for (std::size_t i = 0; i < 3 && i < frames; ++i) {
    const std::string number = std::to_string(frames - 1 - i);
    const std::string name = "f." + std::string(4 - std::min<std::size_t>(4, number.size()), '0');
    EXPECT_GT(mean_of(directory.file(name + number + ".exr")), 0.0);
  }
}

struct BadUse {
  const char* name;
  const char* arguments;
  const char* word;
};

class BadSequence : public ::testing::TestWithParam<BadUse> {};

TEST_P(BadSequence, IsStatusTwoAndLeavesNoFile) {
  const test::TemporaryDirectory directory;
  const ProgramResult result = run_program(std::string("render ") + GetParam().arguments +
                                           " --method direct -o " + directory.file("out.exr"));
  EXPECT_EQ(result.status, 2) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr(GetParam().word));
  EXPECT_EQ(directory.entries(), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Arguments, BadSequence,
    ::testing::Values(
        BadUse{"time_without_animation", "cornell --time 1", "no animation"},
        BadUse{"time_not_a_number", "atrium --time nan", "--time"},
        BadUse{"unknown_animation", "atrium --time 1 --animation night", "0 'door', 1 'day'"},
        BadUse{"animation_of_what_is_still", "atrium --animation day", "--time"},
        BadUse{"no_frames", "atrium --frames 0", "--frames"},
        BadUse{"negative_frames", "atrium --frames=-3", "--frames"},
        BadUse{"no_fps", "atrium --frames 2 --fps 0", "--fps"},
        BadUse{"fps_not_a_number", "atrium --frames 2 --fps nan", "--fps"},
        BadUse{"fps_without_frames", "atrium --fps 25", "--frames"},
        BadUse{"verify_of_a_sequence", "cornell --frames 2 --verify 4", "--verify"},
        BadUse{"updates_without_field", "cornell --frames 2 --frame-updates 2", "--frame-updates"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(RenderSequence, BeginsAsSmoothAsItGoesOn) {
  const ProgramResult result =
      run_program("render cornell --frames 16" + kQuick + "-o " + directory.file("a.exr"));
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto frame = [&](const std::string& number) {
    return read_image(directory.file("a." + number + ".exr")).value();
  };
  const LayeredImage first = frame("0000"), last = frame("0015");
  const Metrics metrics = compare_images(*first.find(""), *last.find(""), {}).value();
  // Measured: 2.1, most of it at the edges of the lamp; 8.5 where the first frame is rendered once
  EXPECT_LT(metrics.relative_rmse, 4.0);
}

TEST_F(RenderSequence, IsAntialiasedOverTimeUnlessThatIsLeftOut) {
  const auto rendered = [&](const std::string& options, const std::string& name) {
    const ProgramResult result = run_program("render cornell-spot --frames 2 --layers " + options +
                                             kQuick + "-o " + directory.file(name));
    EXPECT_EQ(result.status, 0) << result.errors;
    return read_image(directory.file(name.substr(0, 1) + ".0001.exr")).value();
  };
  /// How far the picture is from the sum of what it is made of.
  const auto from_its_parts = [](const LayeredImage& image) {
    double difference = 0.0;
    for (std::size_t i = 0; i < image.find("")->pixels.size(); ++i) {
      double sum = 0.0;
      for (const char* part : {"direct", "indirect", "glossy", "emission"}) {
        sum += image.find(part)->pixels[i];
      }
      difference = std::max(difference, std::abs(sum - image.find("")->pixels[i]));
    }
    return difference;
  };
  const LayeredImage with = rendered("", "a.exr"), without = rendered("--without taa", "b.exr");
  EXPECT_GT(from_its_parts(with), 1e-2);
  EXPECT_LT(from_its_parts(without), 1e-4);
  EXPECT_EQ(with.find("motion")->channels, 2);
  const ProgramResult single =
      run_program("render cornell-spot --without taa" + kQuick + "-o " + directory.file("c.exr"));
  EXPECT_EQ(single.status, 2);
  EXPECT_THAT(single.errors, HasSubstr("--without"));
}

}  // namespace
}  // namespace lambent::render_sequence_test
