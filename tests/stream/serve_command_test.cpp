// SPDX-License-Identifier: Apache-2.0
// lambent serve, as it is typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include "lambent/image.h"
#include "stream/broker/broker.h"
#include "support/certificate.h"
#include "support/http_get.h"
#include "support/program.h"
#include "support/running_server.h"

namespace lambent::serve_command_test {
namespace {

using test::kSmallServer;
using test::ProgramResult;
using test::run_program;
using test::RunningServer;
using ::testing::HasSubstr;

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

TEST(ServeCommand, TellsWhatKeepsItFromStartingBeforeItReadsTheScene) {
  const test::TemporaryDirectory directory;
  RunningServer server;
  ASSERT_GT(server.port(), 0) << server.said();
  test::write_broken_scene(directory.file("broken.gltf"));
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const ProgramResult result =
        run_program("serve " + directory.file("broken.gltf") + " " + arguments);
    EXPECT_NE(result.status, 0) << arguments;
    EXPECT_THAT(result.errors, HasSubstr(why)) << arguments;
  };
  refused("--port " + std::to_string(server.port()), "in use");
  refused("--port 0 --record " + directory.file("broken.gltf") + "/session", "session");
  if (stream::has_broker()) refused("--port 0 --publish nats://127.0.0.1:1/light", "broker");
  refused("--port 0", "broken.gltf");
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

  // Another scene is told at once
  RunningServer again;
  const ProgramResult other = run_program("serve two-rooms --port 0 --light-from " + again.host());
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.errors, HasSubstr("another scene"));
}

TEST(ServeCommand, WaitsForTheServerOfItsLight) {
  std::string light_port, port;
  {
    const RunningServer light, other;
    ASSERT_GT(light.port(), 0) << light.said();
    light_port = std::to_string(light.port());
    port = std::to_string(other.port());
  }
  const pid_t waiting =
      test::start_program({"serve", "cornell-spot", "--light-from", "127.0.0.1:" + light_port,
                           "--port", port, "--size", "160x96"});
  usleep(500'000);
  int status = -1;
  ASSERT_EQ(waitpid(waiting, &status, WNOHANG), 0) << "it has ended";
  std::vector<std::string> again = kSmallServer;
  std::ranges::replace(again, std::string("0"), light_port);
  const RunningServer light({}, again);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto number = static_cast<std::uint16_t>(std::stoi(port));
  while (test::http_get(number, "/healthz").find("ok") == std::string::npos &&
         std::chrono::steady_clock::now() < end) {
    usleep(50'000);
  }
  EXPECT_LT(std::chrono::steady_clock::now(), end);
  kill(waiting, SIGKILL);
  waitpid(waiting, nullptr, 0);
  // An interrupt ends one that waits in vain
  const pid_t in_vain =
      test::start_program({"serve", "cornell-spot", "--light-from", "127.0.0.1:1", "--port", "0"});
  usleep(500'000);
  kill(in_vain, SIGINT);
  waitpid(in_vain, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
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
  refused("--play --port 0", "no animation");
  refused("--light-from localhost --rate 5", "--rate");
  refused("--light-from localhost --probes 3x3x3", "--probes");
  refused("--light-token file", "--light-from");
  refused("--light-from localhost:99999", "1 to 65535");
  refused("--picture-clients 9", "more than --clients 8");
  for (const char* origin : {"foo", "http://x/", "http://x/y", "https://Example.org", "://x",
                             "https://x:443", "http://"}) {
    refused(std::string("--origin ") + origin, "is no origin");
  }
  refused("--origin https://example.org:8443 --origin http://[::1]:3000 --origin null --size 8x8",
          "--size");
  refused("--tokens /nowhere/tokens", "/nowhere/tokens");
  refused("--certificate /nowhere/c.pem --key /nowhere/k.pem", "/nowhere/c.pem");
  EXPECT_EQ(run_program("serve").status, 2);
  EXPECT_EQ(run_program("serve /nowhere.glb").status, 2);
}

}  // namespace
}  // namespace lambent::serve_command_test
