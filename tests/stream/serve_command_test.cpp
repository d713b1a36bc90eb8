// SPDX-License-Identifier: Apache-2.0
// lambent serve and lambent connect, as they are typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "lambent/image.h"
#include "support/certificate.h"
#include "support/http_get.h"
#include "support/program.h"

namespace lambent::serve_command_test {
namespace {

using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;

const std::vector<std::string> kSmall = {
    "serve",  "cornell-spot", "--port",    "0", "--probes", "3x3x3",
    "--rays", "32",           "--updates", "1", "--size",   "160x96"};

/// A server in a process of its own, of which stderr is read.
class RunningServer {
 public:
  explicit RunningServer(const std::vector<std::string>& more = {},
                         const std::vector<std::string>& first = kSmall) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    std::vector<std::string> arguments = first;
    arguments.insert(arguments.end(), more.begin(), more.end());
    const int own = dup(STDERR_FILENO);
    dup2(ends[1], STDERR_FILENO);
    process_ = test::start_program(arguments);
    dup2(own, STDERR_FILENO);
    ::close(own);
    ::close(ends[1]);
    errors_ = ends[0];
    read_until("serving");
    const std::size_t colon = said_.rfind(':', said_.find("/ (Ctrl-C"));
    if (colon != std::string::npos) port_ = std::atoi(said_.c_str() + colon + 1);
  }
  ~RunningServer() {
    end(SIGKILL);
    ::close(errors_);
  }

  int port() const { return port_; }
  const std::string& said() const { return said_; }
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

  /// Sends it a signal and waits; its exit status, -1 where it was killed.
  int end(int signal_number) {
    if (process_ <= 0) return -1;
    kill(process_, signal_number);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    read_until("a line that is never said");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  /// Reads what it says until a line says that, or it says no more.
  void read_until(const std::string& words) {
    std::array<char, 512> buffer;
    for (;;) {
      const std::size_t at = said_.find(words);
      if (at != std::string::npos && said_.find('\n', at) != std::string::npos) return;
      const ssize_t size = read(errors_, buffer.data(), buffer.size());
      if (size <= 0) return;
      said_.append(buffer.data(), static_cast<std::size_t>(size));
    }
  }

  pid_t process_ = -1;
  int errors_ = -1, port_ = 0;
  std::string said_;
};

TEST(ServeCommand, ServesPicturesUntilItIsTerminated) {
  const test::TemporaryDirectory directory;
  RunningServer server;
  ASSERT_GT(server.port(), 0) << server.said();
  EXPECT_THAT(test::http_get(static_cast<std::uint16_t>(server.port()), "/"), HasSubstr("canvas"));
  const std::string file = directory.file("frame.png");
  const ProgramResult one =
      run_program("connect " + server.host() + " -o " + file + " --size 96x64");
  ASSERT_EQ(one.status, 0) << one.errors;
  EXPECT_THAT(one.errors, HasSubstr("frame.png"));
  const auto image = read_image(file);
  ASSERT_TRUE(image);
  EXPECT_GT(image->width, 16);
  const ProgramResult more =
      run_program("connect http://" + server.host() + "/ --frames 3 -o " +
                  directory.file("many.png") + " --eye 2.7,2.7,-5 --target 2.7,2.7,0");
  EXPECT_EQ(more.status, 0) << more.errors;
  EXPECT_EQ(directory.entries(), 4u);
  const std::string layers = directory.file("layers.exr");
  const ProgramResult own = run_program("connect " + server.host() + " --scene cornell-spot -o " +
                                        layers + " --layers --size 32x18 --materials lambert");
  EXPECT_EQ(own.status, 0) << own.errors;
  const auto layered = read_image(layers);
  ASSERT_TRUE(layered);
  EXPECT_NE(layered->find("indirect"), nullptr);
  // Another scene than the server's is not lit by its light
  const ProgramResult other =
      run_program("connect " + server.host() + " --scene atrium -o " + directory.file("other.png"));
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("serves another scene"));
  EXPECT_EQ(directory.entries(), 5u);
  EXPECT_EQ(server.end(SIGTERM), 0);
  EXPECT_THAT(server.said(), HasSubstr("served 4 clients with"));
}

TEST(ServeCommand, AnInterruptEndsItAsWell) {
  RunningServer server;
  ASSERT_GT(server.port(), 0) << server.said();
  EXPECT_EQ(server.end(SIGINT), 0);
}

TEST(ServeCommand, TellsThatThePortIsInUse) {
  RunningServer server;
  ASSERT_GT(server.port(), 0) << server.said();
  const ProgramResult second = run_program("serve cornell-spot --probes 3x3x3 --updates 1 --port " +
                                           std::to_string(server.port()));
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.errors, HasSubstr("in use"));
}

TEST(ServeCommand, IsEncryptedAndAsksForTokens) {
  const test::TemporaryDirectory directory;
  const std::string certificate = directory.file("c.pem"), key = directory.file("k.pem");
  ASSERT_TRUE(test::write_certificate(certificate, key));
  std::ofstream(directory.file("tokens")) << "view looking-looking-looking\n";
  std::ofstream(directory.file("token")) << "looking-looking-looking\n";
  std::ofstream(directory.file("wrong")) << "guessing-guessing-guessing\n";
  RunningServer server({"--certificate", certificate, "--key", key, "--tokens",
                        directory.file("tokens"), "--host", "0.0.0.0"});
  ASSERT_GT(server.port(), 0) << server.said();
  EXPECT_THAT(server.said(), HasSubstr("https://"));
  const std::string connect = "connect https://localhost:" + std::to_string(server.port()) +
                              " -o " + directory.file("a.png") + " --authority " + certificate;
  const ProgramResult wrong = run_program(connect + " --token-file " + directory.file("wrong"));
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("token"));
  const ProgramResult right = run_program(connect + " --token-file " + directory.file("token"));
  EXPECT_EQ(right.status, 0) << right.errors;
  EXPECT_EQ(server.end(SIGTERM), 0);
}

TEST(ServeCommand, GivesItsSceneToWhoMayLookWhereThatIsAllowed) {
  const test::TemporaryDirectory directory;
  std::ofstream(directory.file("tokens")) << "view looking-looking-looking\n";
  const RunningServer open({"--share-scene", "--tokens", directory.file("tokens")});
  ASSERT_GT(open.port(), 0) << open.said();
  const auto asked = [](const RunningServer& server, const std::string& header) {
    return test::http_get(static_cast<std::uint16_t>(server.port()), "",
                          "GET /scene.glb HTTP/1.1\r\nHost: localhost\r\n" + header + "\r\n");
  };
  EXPECT_THAT(asked(open, ""), HasSubstr("401"));
  EXPECT_THAT(asked(open, "Authorization: Bearer guessing-guessing\r\n"), HasSubstr("401"));
  const std::string answer = asked(open, "Authorization: Bearer looking-looking-looking\r\n");
  EXPECT_THAT(answer, HasSubstr("model/gltf-binary"));
  const std::string file = directory.file("scene.glb");
  std::ofstream(file, std::ios::binary) << answer.substr(answer.find("\r\n\r\n") + 4);
  const ProgramResult info = run_program("info " + file);
  EXPECT_EQ(info.status, 0) << info.errors;
  EXPECT_THAT(info.output, HasSubstr("38 triangles"));

  const RunningServer closed;
  ASSERT_GT(closed.port(), 0) << closed.said();
  EXPECT_THAT(asked(closed, ""), HasSubstr("404"));
}

TEST(ServeCommand, RendersInTheLightOfAnotherServerAndOutlivesIt) {
  const test::TemporaryDirectory directory;
  RunningServer light;
  ASSERT_GT(light.port(), 0) << light.said();
  const std::vector<std::string> pictures = {"serve", "cornell-spot", "--port",
                                             "0",     "--size",       "160x96"};
  RunningServer server({"--light-from", light.host()}, pictures);
  ASSERT_GT(server.port(), 0) << server.said();
  const std::string connect =
      "connect " + server.host() + " --size 96x64 -o " + directory.file("a.png");
  const ProgramResult first = run_program(connect);
  EXPECT_EQ(first.status, 0) << first.errors;
  EXPECT_EQ(light.end(SIGKILL), -1);
  const ProgramResult later = run_program(connect);
  EXPECT_EQ(later.status, 0) << later.errors;
  EXPECT_THAT(test::http_get(static_cast<std::uint16_t>(server.port()), "/stats"),
              HasSubstr("\"light_server_connected\":false"));
  EXPECT_EQ(server.end(SIGTERM), 0);
  EXPECT_THAT(server.said(), HasSubstr("has gone"));

  // One that was never there is told at once, and so is another scene
  const ProgramResult nobody = run_program("serve cornell-spot --light-from " + light.host());
  EXPECT_EQ(nobody.status, 1);
  EXPECT_THAT(nobody.errors, HasSubstr("does not answer"));
  RunningServer again;
  const ProgramResult other = run_program("serve two-rooms --light-from " + again.host());
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("another scene"));
}

TEST(ServeCommand, RefusesOptionsThatDoNotGoTogetherBeforeItReadsTheScene) {
  const auto refused = [](const std::string& arguments, const std::string& why) {
    const ProgramResult result = run_program("serve cornell-spot " + arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr(why)) << arguments;
  };
  refused("--host 0.0.0.0", "--tokens");
  refused("--certificate c.pem", "--key");
  refused("--size 8x8", "--size");
  refused("--size 4000x4000", "3840x2160");
  refused("--rate 0", "--rate");
  refused("--port 70000", "--port");
  refused("--quality hihg", "did you mean 'high'?");
  refused("--play", "no animation");
  refused("--light-from localhost --rate 5", "--rate");
  refused("--light-from localhost --probes 3x3x3", "--probes");
  refused("--light-token file", "--light-from");
  refused("--light-from localhost:99999", "1 to 65535");
  refused("--tokens /nowhere/tokens", "/nowhere/tokens");
  refused("--certificate /nowhere/c.pem --key /nowhere/k.pem", "/nowhere/c.pem");
  EXPECT_EQ(run_program("serve").status, 2);
  EXPECT_EQ(run_program("serve /nowhere.glb").status, 2);
}

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
  std::vector<std::string> again = kSmall;
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

TEST(ConnectCommand, NamesItsPicturesWhereItIsInterruptedWithoutAServer) {
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
  EXPECT_EQ(status, 0);
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
}  // namespace lambent::serve_command_test
