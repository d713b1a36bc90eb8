// SPDX-License-Identifier: Apache-2.0
// Light through a broker.
#include "stream/broker/broker.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "stream/broker/frames.h"
#include "stream/client/lit_scene.h"
#include "support/nats_server.h"
#include "support/relayed_scene.h"

namespace lambent::stream::broker_test {
namespace {

using test::becomes_true;
using test::LoopbackSocket;
using test::NatsServer;
using test::RelayedScene;
using test::ServedScene;

TEST(BrokerAddress, HasAHostAndTheNameOfAStream) {
  const auto parsed = parse_broker_address("--publish", "nats://user:pass@host:4222/atrium-1");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->url, "nats://user:pass@host:4222");
  EXPECT_EQ(parsed->name, "atrium-1");
  for (const char* bad : {"host/name", "http://host/name", "nats://host", "nats:///name",
                          "nats://host/", "nats://host/a.b", "nats://host/a*", "nats://host/a/b"}) {
    EXPECT_FALSE(parse_broker_address("--publish", bad)) << bad;
  }
  EXPECT_TRUE(is_broker_address("tls://host/name"));
  EXPECT_FALSE(is_broker_address("localhost:4222"));
}

TEST(BrokerFrames, BringMessagesOfAnySizeAndLeaveOutWhatIsIncomplete) {
  std::mt19937 random(1);
  const std::vector<std::byte> one(10), large(3000, std::byte{7});
  FrameReader reader(4000);
  const auto short_one = write_frames(one, 5, 1, 1024);
  ASSERT_EQ(short_one.size(), 1u);
  const auto read = reader.add(short_one[0]);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->session, 5u);
  EXPECT_EQ(read->sequence, 1u);
  EXPECT_EQ(read->bytes, one);
  const auto frames = write_frames(large, 5, 2, 1024);
  ASSERT_EQ(frames.size(), 3u);
  for (const auto& frame : frames) EXPECT_LE(frame.size(), 1024u);
  EXPECT_FALSE(reader.add(frames[0]));
  EXPECT_FALSE(reader.add(frames[1]));
  EXPECT_EQ(reader.add(frames[2])->bytes, large);
  // One that is lost, twice the same, of another message, too long, and garbage
  EXPECT_FALSE(reader.add(frames[0]));
  EXPECT_FALSE(reader.add(frames[2]));
  EXPECT_FALSE(reader.add(frames[0]));
  EXPECT_FALSE(reader.add(frames[0]));
  EXPECT_FALSE(reader.add(write_frames(large, 5, 3, 1024)[1]));
  for (const auto& frame : write_frames(std::vector<std::byte>(5000), 5, 4, 1024)) {
    EXPECT_FALSE(reader.add(frame));
  }
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::byte> garbage(random() % 40);
    for (std::byte& byte : garbage) byte = static_cast<std::byte>(random() & 3u);
    const auto message = reader.add(garbage);
    EXPECT_LE(message ? message->bytes.size() : 0, 20u);
  }
  for (const auto& frame : frames) static_cast<void>(reader.add(frame));
  EXPECT_TRUE(reader.add(short_one[0]));
}

/// A client with a scene of its own.
class LightClient {
 public:
  explicit LightClient(const ConnectSettings& address)
      : scene_(*scenes::make("cornell-spot")), world_(scene_), lit_(scene_, world_) {
    Hello hello;
    hello.wants = kWantsLight;
    auto joined = join(address, hello);
    if (!joined) {
      ADD_FAILURE() << joined.error().message();
      return;
    }
    client_ = std::move(joined->client);
    role_ = joined->welcome.role;
  }
  Client& client() { return *client_; }
  Role role() const { return role_; }
  const Scene& scene() const { return scene_; }
  std::uint64_t update() const { return lit_.update(); }
  const LightDecoder& decoder() const { return lit_.decoder(); }

  /// Takes messages until there is light of an update, or a later one; false where that never
  /// comes.
  bool follow(std::uint64_t to) {
    const auto end = std::chrono::steady_clock::now() + test::kPatience;
    while (lit_.decoder().needs_key() || lit_.update() < to) {
      if (std::chrono::steady_clock::now() > end) return false;
      const auto message = client_->receive(std::chrono::milliseconds(100));
      if (!message) return false;
      if (!*message) continue;
      const auto followed = lit_.follow(**message);
      EXPECT_TRUE(followed);
      if (!followed || (followed->answer && !client_->send(*followed->answer))) return false;
      if (followed->lit) light_[lit_.update()] = light();
    }
    return true;
  }
  /// The light of all probes after each update that came.
  const std::map<std::uint64_t, std::vector<glm::vec3>>& lights() const { return light_; }

 private:
  std::vector<glm::vec3> light() const {
    const LightDecoder& decoder = lit_.decoder();
    std::vector<glm::vec3> all,
        tile(static_cast<std::size_t>(decoder.irradiance_texels()) * decoder.irradiance_texels());
    for (int probe = 0; probe < decoder.probes(); ++probe) {
      decoder.irradiance(probe, tile);
      all.insert(all.end(), tile.begin(), tile.end());
    }
    return all;
  }

  Scene scene_;
  World world_;
  LitScene lit_;
  std::unique_ptr<Client> client_;
  Role role_ = Role::change;
  std::map<std::uint64_t, std::vector<glm::vec3>> light_;
};

LightInput lamp(std::uint32_t input, float share) {
  LightInput edit;
  edit.input = input;
  edit.edits = kEditsIntensity;
  edit.intensity = share * scenes::make("cornell-spot")->lights[0].intensity;
  return edit;
}

/// A broker, and a server that publishes there.
class Broker : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_broker()) GTEST_SKIP() << "built without LAMBENT_STREAM_NATS";
    nats.emplace();
    if (!nats->runs()) GTEST_SKIP() << "there is no nats-server";
    serve();
  }
  void serve() {
    served.reset();
    ServerSettings settings = ServedScene::small_settings();
    settings.publish = address().broker;
    served =
        std::make_unique<ServedScene>(settings, "cornell-spot", ServedScene::corrected_field());
  }
  ConnectSettings address(const std::string& name = "box") const {
    ConnectSettings settings;
    settings.broker = {nats->address(), name};
    settings.timeout = std::chrono::milliseconds(5'000);
    return settings;
  }

  std::optional<NatsServer> nats;
  std::unique_ptr<ServedScene> served;
};

TEST_F(Broker, HandsOnTheSameLight) {
  LightClient through(address()), direct(served->address());
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(through.role(), Role::view);
  ASSERT_TRUE(through.follow(1));
  ASSERT_TRUE(direct.follow(through.update() + 20));
  ASSERT_TRUE(through.follow(direct.update()));
  int both = 0;
  for (const auto& [update, light] : through.lights()) {
    const auto other = direct.lights().find(update);
    if (other == direct.lights().end()) continue;
    EXPECT_EQ(light, other->second) << update;
    ++both;
  }
  EXPECT_GE(both, 10);
  EXPECT_GT(through.decoder().corrections_number(), 0u);
  EXPECT_TRUE(becomes_true([&] {
    return through.follow(through.update() + 1) && through.decoder().has_corrections();
  })) << "they come after the light";
  EXPECT_FALSE(through.decoder().corrections().empty());
  EXPECT_FALSE(through.client().send(lamp(1, 0.5f))) << "who listens changes nothing";
}

TEST_F(Broker, WhoComesLateHasTheEditsOfAll) {
  test::Watcher editor(served->address(), test::small_hello());
  ASSERT_FALSE(HasFailure());
  ASSERT_TRUE(editor.client().send(lamp(1, 0.5f)));
  ASSERT_FALSE(editor.picture(1).empty());
  LightClient late(address());
  ASSERT_FALSE(HasFailure());
  ASSERT_TRUE(late.follow(1));
  EXPECT_EQ(late.scene().lights[0].intensity, lamp(0, 0.5f).intensity);
  ASSERT_TRUE(editor.client().send(lamp(2, 0.25f)));
  ASSERT_TRUE(becomes_true([&] {
    return late.follow(late.update() + 1) &&
           late.scene().lights[0].intensity == lamp(0, 0.25f).intensity;
  }));
}

TEST_F(Broker, GarbageOfOthersIsLeftOut) {
  LightClient client(address());
  ASSERT_FALSE(HasFailure());
  ASSERT_TRUE(client.follow(1));
  const LoopbackSocket other(nats->port());
  ASSERT_TRUE(other.works());
  for (const std::string payload : {"", "hello", "0123456789012345678901234567890123456789"}) {
    for (const char* subject : {"lambent.box.light", "lambent.box.join"}) {
      ASSERT_TRUE(other.write("PUB " + std::string(subject) + " " + std::to_string(payload.size()) +
                              "\r\n" + payload + "\r\n"));
    }
  }
  ASSERT_TRUE(other.write("PING\r\n"));
  ASSERT_TRUE(other.read_until("PONG"));
  const std::uint64_t before = client.update();
  EXPECT_TRUE(client.follow(before + 10));
  EXPECT_EQ(client.lights().count(before + 5), 1u) << "nothing was left out";
}

TEST_F(Broker, PictureServersStandBehindIt) {
  const RelayedScene relay(address());
  test::Watcher watcher(relay.address(), test::small_hello());
  ASSERT_FALSE(HasFailure());
  EXPECT_FALSE(watcher.picture().empty());
  ASSERT_TRUE(watcher.client().send(lamp(1, 0.0f)));
  const auto refusal = watcher.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::refused_input) << "a broker hands on no edits";
  // The next server is followed, too
  serve();
  EXPECT_TRUE(becomes_true([&] { return relay.stats().light_from->connections >= 2; }));
}

TEST_F(Broker, IsFoundAgainByItsServer) {
  {
    LightClient client(address());
    ASSERT_FALSE(HasFailure());
    ASSERT_TRUE(client.follow(1));
    nats->stop();
    EXPECT_FALSE(client.follow(client.update() + 100'000)) << "the connection has ended";
  }
  nats->start();
  ASSERT_TRUE(nats->runs());
  Hello hello;
  hello.wants = kWantsLight;
  EXPECT_TRUE(becomes_true([&] { return join(address(), hello).has_value(); }));
}

TEST_F(Broker, SaysWhatIsNotThere) {
  Hello hello;
  hello.wants = kWantsLight;
  ConnectSettings settings = address("other");
  settings.timeout = std::chrono::milliseconds(300);
  const auto nobody = join(settings, hello);
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().message().find("no server publishes as other"), std::string::npos);
  hello.wants = kWantsPicture;
  EXPECT_FALSE(join(address(), hello)) << "pictures are each client's own";
  nats->stop();
  hello.wants = kWantsLight;
  const auto no_broker = join(address(), hello);
  ASSERT_FALSE(no_broker);
  EXPECT_NE(no_broker.error().message().find("broker does not answer"), std::string::npos);
}

}  // namespace
}  // namespace lambent::stream::broker_test
