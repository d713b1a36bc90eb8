// SPDX-License-Identifier: Apache-2.0
// Clients that misbehave, vanish or stand still harm nobody.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <random>
#include <string>
#include <vector>

#include "stream/protocol/hello_header.h"
#include "support/http_get.h"
#include "support/protocol_messages.h"
#include "support/served_scene.h"

namespace lambent::stream::hostile_test {
namespace {

using test::http_get;
using test::is_closed;
using test::next;
using test::ServedScene;
using test::small_hello;
using test::Watcher;
using ::testing::HasSubstr;

/// A client that has not said hello.
std::unique_ptr<Client> connect(const ServedScene& served) {
  auto client = Client::connect(served.address());
  EXPECT_TRUE(client) << client.error().message();
  return client ? std::move(*client) : nullptr;
}

std::vector<std::byte> random_bytes(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 255u);
  return bytes;
}

TEST(Hostile, GarbageClosesItsOwnConnectionAlone) {
  const ServedScene served;
  Watcher neighbour(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  std::vector<std::vector<std::byte>> bad;
  for (const std::size_t size : {0u, 1u, 8u, 100u, 512u}) {
    bad.push_back(random_bytes(size, static_cast<std::uint32_t>(size)));
  }
  std::vector<std::byte> cut = write_message(small_hello());
  cut.pop_back();
  bad.push_back(cut);
  for (const auto& [message, sender] : test::one_of_each_message()) {
    if (!std::holds_alternative<Hello>(message)) bad.push_back(write_message(message));
  }
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const auto client = connect(served);
    ASSERT_TRUE(client);
    ASSERT_TRUE(client->send_bytes(bad[i]));
    EXPECT_TRUE(is_closed(*client)) << i;
  }
  // After a hello as well
  for (const auto& bytes : {random_bytes(64, 1), write_message(small_hello()), cut}) {
    auto joined = join(served.address(), small_hello());
    ASSERT_TRUE(joined);
    ASSERT_TRUE(joined->client->send_bytes(bytes));
    EXPECT_TRUE(is_closed(*joined->client));
  }
  EXPECT_GE(served.stats().refused, bad.size());
  EXPECT_FALSE(neighbour.picture().empty());
}

TEST(Hostile, TextAndOversizedMessagesCloseTheConnection) {
  const ServedScene served;
  const auto text = connect(served);
  ASSERT_TRUE(text);
  ASSERT_TRUE(text->send_bytes(std::as_bytes(std::span("hello", 5)), false));
  EXPECT_TRUE(is_closed(*text));
  const auto large = connect(served);
  ASSERT_TRUE(large);
  // It may be gone before all is written
  static_cast<void>(large->send_bytes(std::vector<std::byte>(1u << 20u)));
  EXPECT_TRUE(is_closed(*large));
  EXPECT_TRUE(join(served.address(), small_hello()));
}

TEST(Hostile, AnotherVersionIsToldSo) {
  const ServedScene served;
  const auto client = connect(served);
  ASSERT_TRUE(client);
  Hello hello = small_hello();
  hello.version = kProtocolVersion + 1;
  ASSERT_TRUE(client->send(hello));
  const auto refusal = next<Refusal>(*client);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::other_version);
}

TEST(Hostile, AHelloWithTheRequestIsLookedAtAsAnyOther) {
  const ServedScene served;
  const auto answer_to = [&](const std::string& field) {
    return http_get(served.port(), "",
                    "GET /stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
                    "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nLambent-Hello: " +
                        field + "\r\n\r\n");
  };
  Hello hello = small_hello();
  hello.version = kProtocolVersion + 1;
  const std::string other = hello_header(hello);
  // All at once: the server waits for seconds until a client closes that it has refused
  const std::vector<std::string> sent = {other,
                                         "g",
                                         "zz",
                                         "0x",
                                         other.substr(1),
                                         other.substr(0, other.size() - 2),
                                         std::string(2 * kMaxClientMessageBytes + 2, '0')};
  std::vector<std::future<std::string>> answers;
  answers.reserve(sent.size());
  for (const std::string& field : sent) {
    answers.push_back(std::async(std::launch::async, answer_to, field));
  }
  EXPECT_THAT(answers[0].get(), HasSubstr("this server speaks version"));
  for (std::size_t i = 1; i < sent.size(); ++i) {
    const std::string answer = answers[i].get();
    EXPECT_THAT(answer, HasSubstr("101 Switching"));
    EXPECT_THAT(answer, ::testing::Not(HasSubstr("this server speaks version"))) << sent[i];
  }
  EXPECT_EQ(served.stats().joined, 0u);
  // It comes once, and brings what it would have brought alone
  const auto client = Client::connect(served.address(), small_hello());
  ASSERT_TRUE(client);
  EXPECT_TRUE(next<Welcome>(**client));
  EXPECT_TRUE(next<Picture>(**client));
  ASSERT_TRUE((*client)->send(small_hello()));
  const auto refusal = next<Refusal>(**client);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::bad_message);
}

TEST(Hostile, AFloodOfMessagesEndsTheConnection) {
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.max_message_rate = 20.0;
  const ServedScene served(settings);
  auto joined = join(served.address(), small_hello());
  ASSERT_TRUE(joined);
  for (int i = 0; i < 200; ++i) {
    if (!joined->client->send(Ping{})) break;
  }
  const auto refusal = next<Refusal>(*joined->client);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::too_many);
}

TEST(Hostile, SilentConnectionsAreEnded) {
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.hello_timeout = std::chrono::milliseconds(200);
  const ServedScene served(settings);
  const auto silent = connect(served);
  ASSERT_TRUE(silent);
  const auto refusal = next<Refusal>(*silent);
  ASSERT_TRUE(refusal);
  EXPECT_THAT(refusal->text, HasSubstr("hello"));
  // Nor is half a request waited for
  EXPECT_EQ(http_get(served.port(), "", "GET / HTTP/1.1\r\n"), "");
}

TEST(Hostile, SilentConnectionsGiveWayToThoseThatAsk) {
  ServerSettings settings = ServedScene::small_settings();
  settings.max_clients = 1;
  settings.listen.max_connections = 1;
  const ServedScene served(settings);
  auto joined = join(served.address(), small_hello());
  ASSERT_TRUE(joined);
  // Many more than are accepted, of which half have asked for a WebSocket
  std::vector<test::Connection> silent;
  std::vector<std::unique_ptr<Client>> without_hello;
  for (int i = 0; i < 60; ++i) {
    silent.emplace_back(served.port());
    without_hello.push_back(connect(served));
    ASSERT_TRUE(without_hello.back());
  }
  EXPECT_THAT(http_get(served.port(), "/healthz"), HasSubstr("\r\n\r\nok"));
  EXPECT_GT(served.stats().refused, 50u);
  // Who has joined stays
  EXPECT_TRUE(next<Picture>(*joined->client));
}

TEST(Hostile, HalfOpenConnectionsTimeOut) {
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.idle_timeout = std::chrono::milliseconds(400);
  const ServedScene served(settings);
  // It joins, and is never heard of again: nothing runs on it, so no ping is answered
  auto joined = join(served.address(), small_hello());
  ASSERT_TRUE(joined);
  Watcher neighbour(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  const auto end = std::chrono::steady_clock::now() + test::kPatience;
  while (std::chrono::steady_clock::now() < end) {
    neighbour.picture();
    const auto stats = next<ServerStats>(neighbour.client());
    ASSERT_TRUE(stats) << "the neighbour answers pings, and stays";
    if (stats->clients == 1) return;
  }
  FAIL() << "the dead connection still counts";
}

TEST(Hostile, ASlowClientHasNoQueueAndStallsNobody) {
  const ServedScene served;
  Hello hello = small_hello();
  hello.size = {320, 240};
  // It never reads and never says what it has received
  auto slow = join(served.address(), hello);
  ASSERT_TRUE(slow);
  Watcher neighbour(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  CameraInput camera = neighbour.welcome().camera;
  for (std::uint32_t i = 1; i <= 30; ++i) {
    camera.input = i;
    camera.position_ws.x += 0.01f;
    ASSERT_TRUE(neighbour.client().send(camera));
    // Whatever changes is of interest to the slow one, too
    LightInput lamp;
    lamp.input = i;
    lamp.edits = kEditsIntensity;
    lamp.intensity = glm::vec3(static_cast<float>(i));
    ASSERT_TRUE(neighbour.client().send(lamp));
    ASSERT_FALSE(neighbour.picture(i).empty());
  }
  const std::string stats = http_get(served.port(), "/stats");
  EXPECT_THAT(stats, HasSubstr("\"clients\":2"));
  // Pictures made for the slow one: those under way, and none that waits behind these
  int pictures = 0;
  for (;;) {
    auto message = slow->client->receive(std::chrono::milliseconds(200));
    ASSERT_TRUE(message);
    if (!*message) break;
    if (std::holds_alternative<Picture>(**message)) ++pictures;
  }
  EXPECT_LE(pictures, static_cast<int>(ClientLink::kPicturesUnderWay));
  EXPECT_GE(pictures, 1);
}

TEST(Hostile, NoMoreClientsThanMayBe) {
  ServerSettings settings = ServedScene::small_settings();
  settings.max_clients = 1;
  const ServedScene served(settings);
  auto first = join(served.address(), small_hello());
  ASSERT_TRUE(first);
  const auto second = join(served.address(), small_hello());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message(), HasSubstr("as many clients"));
  first->client->close();
  // Whoever leaves makes room
  const auto end = std::chrono::steady_clock::now() + test::kPatience;
  while (!join(served.address(), small_hello())) {
    ASSERT_LT(std::chrono::steady_clock::now(), end);
  }
}

TEST(Hostile, NoMoreClientsOfPicturesThanHaveMemory) {
  ServerSettings settings = ServedScene::small_settings();
  settings.max_clients = 3;
  settings.max_picture_clients = 1;
  const ServedScene served(settings);
  const auto first = join(served.address(), small_hello());
  ASSERT_TRUE(first);
  EXPECT_FALSE(join(served.address(), small_hello()));
  Hello light = small_hello();
  light.wants = kWantsLight;
  const auto second = join(served.address(), light);
  EXPECT_TRUE(second) << "light takes no renderer";
}

TEST(Http, ServesThePageAndHowItFares) {
  const ServedScene served;
  const std::string page = http_get(served.port(), "/");
  EXPECT_THAT(page, HasSubstr("200 OK"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("<canvas"));
  EXPECT_THAT(http_get(served.port(), "/page.js"), HasSubstr("VideoDecoder"));
  EXPECT_THAT(http_get(served.port(), "/protocol.js"), HasSubstr("text/javascript"));
  EXPECT_THAT(http_get(served.port(), "/page.css"), HasSubstr("text/css"));
  EXPECT_THAT(http_get(served.port(), "/healthz"), HasSubstr("\r\n\r\nok"));
  EXPECT_THAT(http_get(served.port(), "/stats"), HasSubstr("\"clients\":0"));
}

TEST(Http, RefusesWhatIsNotForIt) {
  const ServedScene served;
  EXPECT_THAT(http_get(served.port(), "/../etc/passwd"), HasSubstr("404"));
  EXPECT_THAT(http_get(served.port(), "/stream"), HasSubstr("426"));
  EXPECT_THAT(http_get(served.port(), "", "POST / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              HasSubstr("405"));
  EXPECT_THAT(http_get(served.port(), "", "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"),
              HasSubstr("421"));
  const std::string upgrade =
      "GET /stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  EXPECT_THAT(http_get(served.port(), "", upgrade + "Origin: http://evil.example\r\n\r\n"),
              HasSubstr("403"));
  EXPECT_EQ(http_get(served.port(), "", "GET /" + std::string(20'000, 'a') + " HTTP/1.1\r\n\r\n"),
            "");
  ConnectSettings address = served.address();
  address.origin = "http://evil.example";
  EXPECT_FALSE(Client::connect(address));
  address.origin = "http://127.0.0.1:" + std::to_string(served.port());
  EXPECT_TRUE(Client::connect(address));
}

}  // namespace
}  // namespace lambent::stream::hostile_test
