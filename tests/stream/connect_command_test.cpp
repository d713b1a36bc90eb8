// SPDX-License-Identifier: Apache-2.0
// lambent connect, as it is typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "lambent/image.h"
#include "support/program.h"
#include "support/running_server.h"

namespace lambent::connect_command_test {
namespace {

using test::kSmallServer;
using test::ProgramResult;
using test::run_program;
using test::RunningServer;
using ::testing::HasSubstr;

TEST(ConnectCommand, GoesOnOnceItsServerIsBack) {
  const test::TemporaryDirectory directory;
  RunningServer first;
  ASSERT_GT(first.port(), 0) << first.said();
  const std::string port = std::to_string(first.port());
  const auto connect = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "connect", first.host(), "--frames",  "200", "-o", directory.file(name + ".png"),
        "--size",  "96x64",      "--timeout", "60"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::start_program(arguments);
  };
  const auto has = [&](const std::string& name, const std::string& frame) {
    return std::filesystem::exists(directory.file(name + "." + frame + ".png"));
  };
  /// Waits until both clients have written a frame.
  const auto wait_for = [&](const std::string& frame) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!has("seen", frame) || !has("lit", frame)) {
      if (std::chrono::steady_clock::now() > end) return false;
      usleep(10'000);
    }
    return true;
  };
  const std::array<pid_t, 2> clients = {
      connect("seen", {"--eye", "2.7,2.7,-5", "--target", "2.7,2.7,0"}),
      connect("lit", {"--scene", "cornell-spot", "--quality", "draft"})};
  EXPECT_TRUE(wait_for("0000"));
  EXPECT_EQ(first.end(SIGKILL), -1);
  // Of a scene at rest, a server sends fewer pictures than these, and light until it has settled
  EXPECT_FALSE(has("seen", "0017"));
  std::vector<std::string> again = kSmallServer;
  std::ranges::replace(again, std::string("0"), port);
  const RunningServer second({}, again);
  EXPECT_EQ(std::to_string(second.port()), port) << second.said();
  EXPECT_TRUE(wait_for("0020"));
  // They wait for the rest, and end at once
  for (const pid_t client : clients) {
    kill(client, SIGKILL);
    waitpid(client, nullptr, 0);
  }
}

TEST(ConnectCommand, EndsWhereItIsInterruptedWithoutAServer) {
  const test::TemporaryDirectory directory;
  RunningServer server;
  ASSERT_GT(server.port(), 0) << server.said();
  const pid_t client =
      test::start_program({"connect", server.host(), "--frames", "200", "-o",
                           directory.file("a.png"), "--size", "96x64", "--timeout", "60"});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(directory.file("a.0000.png")) &&
         std::chrono::steady_clock::now() < end) {
    usleep(10'000);
  }
  EXPECT_EQ(server.end(SIGKILL), -1);
  usleep(300'000);  // it has begun to look for the server
  kill(client, SIGINT);
  int status = -1;
  waitpid(client, &status, 0);
  // As a shell expects, which makes 130 of it
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
}

TEST(ConnectCommand, EndsAsShellsExpectWhereItIsInterruptedBeforeAllIsWritten) {
  const test::TemporaryDirectory directory;
  const RunningServer server;
  ASSERT_GT(server.port(), 0) << server.said();
  // Of a scene at rest fewer pictures come than are asked for
  const pid_t client =
      test::start_program({"connect", server.host(), "--frames", "200", "-o",
                           directory.file("a.png"), "--size", "96x64", "--timeout", "60"});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(directory.file("a.0002.png")) &&
         std::chrono::steady_clock::now() < end) {
    usleep(10'000);
  }
  kill(client, SIGINT);
  int status = -1;
  waitpid(client, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
  EXPECT_LT(std::chrono::steady_clock::now(), end) << "it does not wait for the next picture";
  EXPECT_TRUE(read_image(directory.file("a.0002.png")));
}

TEST(ConnectCommand, ReadsItsSceneBeforeItJoinsTheServer) {
  const test::TemporaryDirectory directory;
  // That this cannot be read is found out after all that can be told before
  std::ofstream(directory.file("broken.gltf"))
      << R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "none.bin", "byteLength": 9}]})";
  // Nobody listens there, which it would tell first
  const ProgramResult result =
      run_program("connect 127.0.0.1:1 --scene " + directory.file("broken.gltf") + " -o " +
                  directory.file("a.png") + " --timeout 2");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("broken.gltf"));
}

TEST(ConnectCommand, TellsWhatIsWrong) {
  const test::TemporaryDirectory directory;
  const std::string out = " -o " + directory.file("a.png") + " --timeout 2";
  const ProgramResult nobody = run_program("connect 127.0.0.1:1" + out);
  EXPECT_EQ(nobody.status, 1);
  EXPECT_THAT(nobody.errors, HasSubstr("127.0.0.1:1"));
  EXPECT_EQ(run_program("connect localhost:99999" + out).status, 2);
  EXPECT_EQ(run_program("connect localhost -o a.exr").status, 2);
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const ProgramResult result = run_program("connect " + arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr(why)) << arguments;
  };
  refused("ftp://localhost" + out, "neither http://");
  refused("localhost:8080/stream" + out, "has a path");
  refused("localhost --token-file " + directory.file("none") + out, "no such file");
  refused("localhost --scene cornell --layers" + out, ".exr");
  refused("localhost --exposure 1" + out, "--scene");
  EXPECT_EQ(run_program("connect localhost --eye 1,2,3" + out).status, 2);
  EXPECT_EQ(directory.entries(), 0u);
}

}  // namespace
}  // namespace lambent::connect_command_test
