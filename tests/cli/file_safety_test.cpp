// SPDX-License-Identifier: Apache-2.0
// No file is lost to another one of the same command, and none is left half written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::file_safety_test {
namespace {

namespace fs = std::filesystem;
using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;

const std::string kQuick = "--method direct --size 16x12 --samples 1 ";

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class FileSafety : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return directory.file(name); }

  /// The command is refused, names both uses of the file, and `kept` stays as it is.
  void expect_refusal(const std::string& command, const std::string& clash,
                      const std::string& kept = "") const {
    const std::string before = kept.empty() ? "" : text_of(kept);
    const std::size_t entries = directory.entries();
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(result.errors, HasSubstr(clash)) << command;
    EXPECT_EQ(directory.entries(), entries) << command;
    EXPECT_EQ(kept.empty() ? "" : text_of(kept), before) << command;
  }

  test::TemporaryDirectory directory;
};

TEST_F(FileSafety, TwoOutputsOfRenderMayNotBeOneFile) {
  expect_refusal("render cornell " + kQuick + "-o " + file("s.png") + " --stats " + file("s.png"),
                 "both -o and --stats would write this file");
  fs::create_symlink("s.png", directory.path() / "later.json");
  expect_refusal(
      "render cornell " + kQuick + "-o " + file("s.png") + " --stats " + file("later.json"),
      "and --stats would write this file");
}

TEST_F(FileSafety, FramesOfASequenceAreOutputs) {
  const std::string sequence = "render cornell " + kQuick + "--frames 2 -o ";
  expect_refusal(sequence + file("f.png") + " --stats " + file("f.0001.png"), "--stats and -o");
  fs::create_symlink("f.0001.png", directory.path() / "stats.json");
  expect_refusal(sequence + file("f.png") + " --stats " + file("stats.json"),
                 "and -o would write this file");
  fs::create_directory(directory.path() / "0000");
  fs::create_directory(directory.path() / "0001");
  expect_refusal(sequence + file("####/f.png") + " --stats " + file("0001/f.png"),
                 "would write this file");
  // The third frame is none of two
  const auto fine = run_program(sequence + file("g.png") + " --stats " + file("g.0002.png"));
  EXPECT_EQ(fine.status, 0) << fine.errors;
}

TEST_F(FileSafety, FramesMayNotReplaceWhatTheyAreMadeOf) {
  ASSERT_EQ(run_program("make-scene cube -o " + file("cube.glb")).status, 0);
  fs::create_hard_link(file("cube.glb"), file("f.0001.png"));
  expect_refusal("render " + file("cube.glb") + " " + kQuick + "--frames 2 -o " + file("f.png"),
                 "-o would write over the scene", file("cube.glb"));
}

TEST_F(FileSafety, AnOutputMayNotBeTheScene) {
  const std::string scene = file("c.glb");
  ASSERT_EQ(run_program("make-scene cube -o " + scene).status, 0);
  expect_refusal("prepare " + scene + " -o " + scene, "c.glb: ", scene);
  fs::create_symlink("c.glb", directory.path() / "soft");
  fs::create_hard_link(scene, file("hard"));
  for (const char* output : {"./soft", "hard"}) {
    expect_refusal("prepare " + scene + " -o " + file(output), "-o would write over the scene",
                   scene);
    expect_refusal("bake " + scene + " -o " + file(output), "-o would write over the scene", scene);
  }
  fs::create_hard_link(scene, file("hard.png"));
  expect_refusal("render " + scene + " " + kQuick + "-o " + file("hard.png"),
                 "-o would write over the scene", scene);
  expect_refusal(
      "render " + scene + " " + kQuick + "-o " + file("a.png") + " --stats " + file("hard"),
      "--stats would write over the scene", scene);
}

TEST_F(FileSafety, AnOutputMayNotBeAFileOfTheScene) {
  std::ofstream(file("scene.gltf")) << R"({"asset": {"version": "2.0"},
    "buffers": [{"byteLength": 3, "uri": "my%20data.png"}], "images": [{"uri": "wood.png"}]})";
  std::ofstream(file("my data.png")) << "abc";
  std::ofstream(file("wood.png")) << "def";
  for (const char* name : {"my data.png", "wood.png"}) {
    expect_refusal("render " + file("scene.gltf") + " " + kQuick + "-o '" + file(name) + "'",
                   "-o would write over a file of the scene", file(name));
  }
}

TEST_F(FileSafety, ThePicturesThatAreComparedAreKept) {
  const std::string q = file("q.png");
  ASSERT_EQ(run_program("render cornell " + kQuick + "-o " + q).status, 0);
  expect_refusal("compare " + q + " " + q + " --heatmap " + q, "--heatmap would write over", q);
  fs::create_symlink("q.png", directory.path() / "l.png");
  expect_refusal("picture " + q + " -o " + file("l.png"), "-o would write over the image", q);
}

TEST_F(FileSafety, TheFieldThatIsExportedOrReadIsKept) {
  const std::string baked = file("x.field"), field = file("x.irradiance.exr");
  ASSERT_EQ(run_program("bake cornell --probes 2x2x2 --rays 16 --updates 1 -o " + baked).status, 0);
  fs::rename(baked, field);
  expect_refusal("field export " + field + " -o " + file("x"), "-o would write over the field",
                 field);
  expect_refusal("render cornell --size 8x8 --samples 1 --field " + field + " -o " + field,
                 "-o would write over --field", field);
}

TEST_F(FileSafety, WritesThroughALinkAndKeepsIt) {
  fs::create_symlink("target.png", directory.path() / "link.png");
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(run_program("render cornell " + kQuick + "-o " + file("link.png")).status, 0);
    EXPECT_TRUE(fs::is_symlink(file("link.png")));
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(file("target.png"))));
  }
  EXPECT_EQ(directory.entries(), 2u);
}

TEST_F(FileSafety, StatisticsGoWhereStandardOutputDoes) {
  const std::string command = "render cornell " + kQuick + "-o " + file("a.png");
  EXPECT_THAT(run_program(command + " --stats /dev/stdout").output, HasSubstr("camera_rays"));
  std::ofstream(file("log")) << "kept\n";
  ASSERT_EQ(run_program(command + " --stats /dev/stdout >>" + file("log")).status, 0);
  EXPECT_EQ(text_of(file("log")).substr(0, 5), "kept\n");
  EXPECT_THAT(text_of(file("log")), HasSubstr("camera_rays"));
}

TEST_F(FileSafety, AFullDiskIsAFailureThatLeavesNothing) {
  for (const char* name : {"a.exr", "a.png"}) {
    const std::string output = file(name);
    const auto result =
        run_program("render cornell --method direct --size 96x96 -o " + output, "ulimit -f 4;");
    EXPECT_EQ(result.status, 1) << name;
    EXPECT_THAT(result.errors, HasSubstr(output + ": cannot write: File too large"));
    EXPECT_EQ(directory.entries(), 0u) << name;
  }
}

/// Starts the program, sends it a signal after a while, and returns how it ended.
int interrupted(const std::vector<std::string>& arguments, int number,
                std::chrono::microseconds after) {
  const pid_t child = test::start_program(arguments);
  std::this_thread::sleep_for(after);
  kill(child, number);
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

TEST_F(FileSafety, AnInterruptAtAnyMomentLeavesTheOldFileOrTheNewOne) {
  const std::string output = file("x.exr");
  const std::vector<std::string> arguments = {"render",   "cornell", "--method",  "direct",
                                              "--size",   "256x256", "--samples", "1",
                                              "--layers", "-o",      output};
  const auto start = std::chrono::steady_clock::now();
  ASSERT_TRUE(WIFEXITED(interrupted(arguments, 0, std::chrono::microseconds(0))));
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now() - start);
  const std::string complete = text_of(output);
  ASSERT_FALSE(complete.empty());

  // The first half begins without the file, the second half replaces it
  constexpr int kTimes = 20;
  int ended_by_signal = 0;
  for (int i = 0; i < kTimes; ++i) {
    if (i < kTimes / 2) {
      fs::remove(output);
    } else {
      std::ofstream(output, std::ios::binary) << complete;
    }
    const int number = i % 2 == 0 ? SIGINT : SIGTERM;
    const int status = interrupted(arguments, number, whole * (i % (kTimes / 2)) / (kTimes / 2));
    if (WIFSIGNALED(status)) {
      EXPECT_EQ(WTERMSIG(status), number);
      ++ended_by_signal;
    } else {
      EXPECT_EQ(WEXITSTATUS(status), 0);
    }
    for (const auto& entry : fs::directory_iterator(directory.path())) {
      EXPECT_EQ(entry.path().string(), output);
      EXPECT_TRUE(text_of(output) == complete);
    }
    EXPECT_TRUE(i < kTimes / 2 || fs::exists(output));
  }
  EXPECT_GT(ended_by_signal, 0);
}

}  // namespace
}  // namespace lambent::file_safety_test
