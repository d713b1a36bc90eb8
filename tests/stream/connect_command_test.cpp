// SPDX-License-Identifier: Apache-2.0
// lambent connect, as it is typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
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

/// Starts a client that asks for more frames than come of a scene at rest, and writes them to
/// NAME.0000.png, ...
pid_t start_client(const RunningServer& server, const std::string& name,
                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"connect",   server.host(), "--frames", "200",
                                        "-o",        name + ".png", "--size",   "96x64",
                                        "--timeout", "60"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test::start_program(arguments);
}

/// Waits until all of these files are there; whether they came in time.
bool appear(const std::vector<std::string>& files) {
  const auto is_there = [](const std::string& file) { return std::filesystem::exists(file); };
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::ranges::all_of(files, is_there)) {
    if (std::chrono::steady_clock::now() > end) return false;
    usleep(10'000);
  }
  return true;
}

/// Interrupts a client; whether that ends it as a shell expects, which makes 130 of it.
bool ends_by_interrupt(pid_t client) {
  kill(client, SIGINT);
  int status = -1;
  waitpid(client, &status, 0);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGINT;
}

TEST(ConnectCommand, GoesOnOnceItsServerIsBack) {
  const test::TemporaryDirectory directory;
  RunningServer first;
  ASSERT_GT(first.port(), 0) << first.said();
  const std::string port = std::to_string(first.port());
  const std::string seen = directory.file("seen"), lit = directory.file("lit");
  const std::array<pid_t, 2> clients = {
      start_client(first, seen, {"--eye", "2.7,2.7,-5", "--target", "2.7,2.7,0"}),
      start_client(first, lit, {"--scene", "cornell-spot", "--quality", "draft"})};
  EXPECT_TRUE(appear({seen + ".0000.png", lit + ".0000.png"}));
  EXPECT_EQ(first.end(SIGKILL), -1);
  // Of a scene at rest, a server sends fewer pictures than these, and light until it has settled
  EXPECT_FALSE(std::filesystem::exists(seen + ".0017.png"));
  std::vector<std::string> again = kSmallServer;
  std::ranges::replace(again, std::string("0"), port);
  const RunningServer second({}, again);
  EXPECT_EQ(std::to_string(second.port()), port) << second.said();
  EXPECT_TRUE(appear({seen + ".0020.png", lit + ".0020.png"}));
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
  const pid_t client = start_client(server, directory.file("a"));
  EXPECT_TRUE(appear({directory.file("a.0000.png")}));
  EXPECT_EQ(server.end(SIGKILL), -1);
  usleep(300'000);  // it has begun to look for the server
  EXPECT_TRUE(ends_by_interrupt(client));
}

TEST(ConnectCommand, EndsAsShellsExpectWhereItIsInterruptedBeforeAllIsWritten) {
  const test::TemporaryDirectory directory;
  const RunningServer server;
  ASSERT_GT(server.port(), 0) << server.said();
  const pid_t client = start_client(server, directory.file("a"));
  EXPECT_TRUE(appear({directory.file("a.0002.png")}));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(ends_by_interrupt(client));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30))
      << "it does not wait for the next picture";
  EXPECT_TRUE(read_image(directory.file("a.0002.png")));
}

TEST(ConnectCommand, ReadsItsSceneBeforeItJoinsTheServer) {
  const test::TemporaryDirectory directory;
  test::write_broken_scene(directory.file("broken.gltf"));
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
