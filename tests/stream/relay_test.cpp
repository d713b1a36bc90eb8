// SPDX-License-Identifier: Apache-2.0
// Picture servers in the light of another server.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "core/image/tone_map.h"
#include "stream/client/lit_scene.h"
#include "support/certificate.h"
#include "support/relayed_scene.h"
#include "support/temporary_directory.h"

namespace lambent::stream::relay_test {
namespace {

using test::becomes_true;
using test::next;
using test::RelayedScene;
using test::ServedScene;
using test::small_hello;
using test::Watcher;

double mean(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += static_cast<double>(value);
  return sum / static_cast<double>(image.pixels.size());
}

/// Averages pictures of what does not change, as a picture has but one sample a pixel.
Image averaged(Watcher& watcher) {
  constexpr int kPictures = 12;
  Image sum = watcher.picture();
  for (int i = 1; i < kPictures; ++i) {
    const Image one = watcher.picture();
    if (one.pixels.size() != sum.pixels.size()) return {};
    for (std::size_t p = 0; p < sum.pixels.size(); ++p) sum.pixels[p] += one.pixels[p];
  }
  for (float& value : sum.pixels) value /= kPictures;
  return sum;
}

double rmse(const Image& a, const Image& b) {
  if (a.pixels.empty() || a.pixels.size() != b.pixels.size()) return 1.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = a.pixels[i] - b.pixels[i];
    squares += difference * difference;
  }
  return std::sqrt(squares / static_cast<double>(a.pixels.size()));
}

LightInput lamp(std::uint32_t input, float share) {
  LightInput edit;
  edit.input = input;
  edit.edits = kEditsIntensity;
  edit.intensity = share * scenes::make("cornell-spot")->lights[0].intensity;
  return edit;
}

/// What the server of the light tells of itself, where it is connected to.
LightFrom light_from(const RelayedScene& relay) {
  return relay.stats().light_from.value_or(LightFrom{});
}

TEST(Relay, TwoPictureServersShowTheLightThatTheirServerShows) {
  const ServedScene served;
  const RelayedScene one(served.address()), two(served.address());
  Watcher there(served.address(), small_hello()), here(one.address(), small_hello()),
      also(two.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  const Image theirs = averaged(there), ours = averaged(here), others = averaged(also);
  EXPECT_GT(mean(theirs), 0.1);
  // Noise of so many samples a pixel, the codec's of pictures, and 1 % of the light
  EXPECT_LT(rmse(theirs, ours), 0.03);
  EXPECT_LT(rmse(theirs, others), 0.03);
  EXPECT_NEAR(mean(theirs), mean(ours), 0.01);
  EXPECT_NEAR(mean(ours), mean(others), 0.005);
  EXPECT_EQ(one.stats().joined, 1u);
  EXPECT_EQ(served.stats().joined, 3u);
}

TEST(Relay, AnEditAtOneIsSeenByAll) {
  const ServedScene served;
  const RelayedScene one(served.address()), two(served.address());
  Watcher there(served.address(), small_hello()), here(one.address(), small_hello()),
      also(two.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  EXPECT_GT(mean(here.picture()), 0.1);
  ASSERT_TRUE(here.client().send(lamp(1, 0.0f)));
  // Its input is shown once it has come back with its light
  EXPECT_LT(mean(here.picture(1)), 0.01);
  const auto dark = [](Watcher& watcher) {
    for (int i = 0; i < 500; ++i) {
      if (mean(watcher.picture()) < 0.01) return true;
    }
    return false;
  };
  EXPECT_TRUE(dark(there));
  EXPECT_TRUE(dark(also));
  // Whoever comes now sees it, too
  Watcher late(two.address(), small_hello());
  EXPECT_LT(mean(late.picture()), 0.01);
}

TEST(Relay, RefusesWhatIsNotThereAndGoesOn) {
  const ServedScene served;
  const RelayedScene relay(served.address());
  Watcher watcher(relay.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  LightInput edit = lamp(1, 1.0f);
  edit.light = 99;
  ASSERT_TRUE(watcher.client().send(edit));
  const auto refusal = watcher.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::refused_input);
  EXPECT_NE(refusal->text.find("no such light"), std::string::npos);
  ASSERT_TRUE(watcher.client().send(lamp(2, 0.0f)));
  EXPECT_LT(mean(watcher.picture(2)), 0.01);
}

/// A server on this port, which may have just been left by another one.
std::unique_ptr<ServedScene> serve_at(std::uint16_t port) {
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.port = port;
  return std::make_unique<ServedScene>(settings);
}

TEST(Relay, KeepsTheLastLightWhereItsServerGoesAndFollowsTheNextOne) {
  auto served = serve_at(0);
  const std::uint16_t port = served->port();
  const RelayedScene relay(served->address());
  Watcher watcher(relay.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  const double lit = mean(watcher.picture());
  ASSERT_TRUE(watcher.client().send(lamp(1, 0.5f)));
  const double half = mean(watcher.picture(1));
  EXPECT_LT(half, 0.85 * lit);
  served.reset();
  ASSERT_TRUE(becomes_true([&] { return !light_from(relay).connected; }));
  EXPECT_FALSE(light_from(relay).lost_because.empty());

  // It shows what it has, and says that nothing can be changed
  Watcher late(relay.address(), small_hello());
  EXPECT_NEAR(mean(late.picture()), half, 0.02);
  ASSERT_TRUE(late.client().send(lamp(1, 0.0f)));
  const auto refusal = late.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::refused_input);
  EXPECT_NEAR(mean(late.picture(1)), half, 0.02);

  // The next server has the scene as it was opened, with all light
  served = serve_at(port);
  const auto back = Clock::now();
  ASSERT_TRUE(becomes_true([&] { return light_from(relay).connected; }));
  EXPECT_LT(Clock::now() - back, std::chrono::seconds(1));
  EXPECT_EQ(light_from(relay).connections, 2u);
  EXPECT_EQ(light_from(relay).lost_because, "") << "it is there";
  double now = 0.0;
  for (int i = 0; i < 500 && std::abs(now - lit) > 0.02; ++i) now = mean(late.picture());
  EXPECT_NEAR(now, lit, 0.02);
  // And edits reach it
  ASSERT_TRUE(late.client().send(lamp(2, 0.0f)));
  EXPECT_LT(mean(late.picture(2)), 0.01);
}

/// A client of light that keeps its messages.
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
  }
  Client& client() { return *client_; }
  const LightDecoder& light() const { return lit_.decoder(); }
  const Scene& scene() const { return scene_; }

  /// Follows until the light is of an update, or a later one.
  bool follow(std::uint64_t update) {
    const auto end = Clock::now() + test::kPatience;
    while (light().needs_key() || light().update() < update) {
      if (Clock::now() > end || !step()) return false;
    }
    return true;
  }
  /// Follows a message.
  bool step() {
    const auto message = client_->receive(test::kPatience);
    if (!message || !*message) return false;
    if (const auto* told = std::get_if<InputsApplied>(&**message)) applied_ = *told;
    const auto followed = lit_.follow(**message);
    EXPECT_TRUE(followed);
    if (!followed) return false;
    return !followed->answer || !answers_ || client_->send(*followed->answer);
  }
  /// Whether light is answered.
  void answer(bool answers) { answers_ = answers; }
  std::optional<InputsApplied> applied() const { return applied_; }

 private:
  Scene scene_;
  World world_;
  LitScene lit_;
  std::unique_ptr<Client> client_;
  std::optional<InputsApplied> applied_;
  bool answers_ = true;
};

TEST(Relay, HandsLightOnToClientsAndServersOfItsOwnToTheBit) {
  const ServedScene served;
  const RelayedScene relay(served.address()), leaf(relay.address());
  LightClient root(served.address()), first(leaf.address());
  ASSERT_FALSE(HasFailure());
  ASSERT_TRUE(first.follow(1));
  ASSERT_TRUE(first.client().send(lamp(7, 0.5f)));
  // The edit goes up the tree, and comes down again with its light
  const auto told = [&] {
    return first.applied() && first.light().update() >= first.applied()->update;
  };
  for (int i = 0; i < 500 && !told(); ++i) ASSERT_TRUE(first.follow(first.light().update() + 1));
  ASSERT_TRUE(first.applied());
  EXPECT_EQ(first.applied()->input, 7u);
  EXPECT_EQ(first.scene().lights[0].intensity, lamp(0, 0.5f).intensity);

  LightClient late(leaf.address());
  ASSERT_TRUE(late.follow(first.light().update() + 3));
  EXPECT_EQ(late.scene().lights[0].intensity, lamp(0, 0.5f).intensity);
  ASSERT_TRUE(first.follow(late.light().update()));
  ASSERT_TRUE(late.follow(first.light().update()));
  ASSERT_TRUE(root.follow(late.light().update()));
  ASSERT_TRUE(late.follow(root.light().update()));
  ASSERT_TRUE(first.follow(root.light().update()));
  for (const LightClient* client : {&first, &late}) {
    ASSERT_EQ(client->light().update(), root.light().update());
    const auto ours = client->light().join(), theirs = root.light().join();
    ASSERT_TRUE(ours && theirs);
    ASSERT_EQ(ours->size(), theirs->size());
    for (std::size_t i = 0; i < ours->size(); ++i) {
      EXPECT_EQ((*ours)[i].bytes, (*theirs)[i].bytes);
    }
  }
  EXPECT_GT(relay.stats().light_bytes, 0u);
}

TEST(Relay, HandsCorrectionsOnToWhoIsThereAndToWhoComesLate) {
  const ServedScene served(ServedScene::small_settings(), "cornell-spot",
                           ServedScene::corrected_field());
  const RelayedScene relay(served.address()), leaf(relay.address());
  for (int i = 0; i < 2; ++i) {
    LightClient client(leaf.address());
    ASSERT_FALSE(HasFailure());
    ASSERT_TRUE(client.follow(1));
    const auto has_all = [&] {
      return client.light().has_corrections() && !client.light().corrections().empty();
    };
    for (int step = 0; step < 500 && !has_all(); ++step) ASSERT_TRUE(client.step());
    EXPECT_TRUE(has_all()) << i;
  }
}

TEST(Relay, LightOfAServerThatStartsAnewReachesClientsOfLight) {
  auto served = serve_at(0);
  const std::uint16_t port = served->port();
  const RelayedScene relay(served->address());
  LightClient client(relay.address());
  ASSERT_TRUE(client.follow(20));
  ASSERT_TRUE(client.client().send(lamp(1, 0.5f)));
  while (client.scene().lights[0].intensity != lamp(0, 0.5f).intensity) {
    ASSERT_TRUE(client.follow(client.light().update() + 1));
  }
  // Some of it stays without an answer
  client.answer(false);
  ASSERT_TRUE(client.follow(client.light().update() + 3));
  served.reset();
  served = serve_at(port);
  // Updates are counted from 1 again
  std::uint64_t last = client.light().update();
  for (int i = 0; i < 1000 && client.light().update() >= last; ++i) ASSERT_TRUE(client.step());
  EXPECT_LT(client.light().update(), last);
  EXPECT_EQ(client.scene().lights[0].intensity, lamp(0, 1.0f).intensity);
  // More than may be under way without an answer
  client.answer(true);
  last = client.light().update();
  EXPECT_TRUE(client.follow(last + ClientLink::kMostUpdatesUnderWay + 10));
}

TEST(LitScene, IsAtRestWhereItsServerDoesNotPlay) {
  Scene scene = scenes::make("cornell-spot").value();
  const glm::vec3 place = scene.lights[0].position_ws;
  scene.rig.nodes.emplace_back().translation = place;
  RigLight& lamp_of_rig = scene.rig.lights.emplace_back();
  lamp_of_rig.node = 0;
  Channel& channel = scene.animations.emplace_back().channels.emplace_back();
  channel.target = Channel::Target::node_translation;
  channel.curve = {Interpolation::linear, 3, {0.0f, 1.0f}, {0, 0, 0, 0, 1, 0}};
  ASSERT_TRUE(validate(scene));
  World world(scene);
  LitScene lit(scene, world);
  LightPayload light;
  light.time_s = 1.0f;
  ASSERT_TRUE(lit.follow(Message(light)));
  EXPECT_EQ(scene.lights[0].position_ws, glm::vec3(0, 1, 0));
  // A server that starts anew, and does not play
  light.time_s = -1.0f;
  ASSERT_TRUE(lit.follow(Message(light)));
  EXPECT_EQ(scene.lights[0].position_ws, place);
}

TEST(LitScene, TakesBackWhatItsServerEdited) {
  Scene scene = scenes::make("cornell-spot").value();
  const glm::vec3 intensity = scene.lights[0].intensity;
  World world(scene);
  LitScene lit(scene, world);
  LightInput edit;
  edit.edits = kEditsIntensity;
  edit.intensity = 3.0f * intensity;
  ASSERT_TRUE(lit.follow(Message(edit)));
  ASSERT_EQ(scene.lights[0].intensity, edit.intensity);
  LightInput of_none = edit;
  of_none.light = 1'000'000;
  ASSERT_FALSE(lit.follow(Message(of_none)));
  ASSERT_TRUE(lit.restore());
  EXPECT_EQ(scene.lights[0].intensity, intensity);
}

TEST(Relay, IsKnownToItsServerByATokenAndChecksItsCertificate) {
  const std::string look = "looking-looking-looking";
  const test::TemporaryDirectory directory;
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.certificate = directory.file("certificate.pem");
  settings.listen.key = directory.file("key.pem");
  settings.listen.tokens = directory.file("tokens");
  ASSERT_TRUE(test::write_certificate(settings.listen.certificate, settings.listen.key));
  std::ofstream(settings.listen.tokens) << "view " << look << "\n";
  const ServedScene served(settings);
  UpstreamSettings from;
  from.connect = served.address();
  from.connect.host = "localhost";
  from.connect.tls = true;
  from.token = look;
  const auto untrusted = Upstream::open(from);
  ASSERT_FALSE(untrusted) << "nobody trusts it";
  EXPECT_EQ(untrusted.error().kind, Error::Kind::bad_input) << "waiting does not help";
  from.connect.authority = settings.listen.certificate;
  from.token = "guessed-guessed-guessed";
  const auto guessed = Upstream::open(from);
  ASSERT_FALSE(guessed);
  EXPECT_NE(guessed.error().message().find("token"), std::string::npos);
  from.token = look;
  const RelayedScene relay(from);
  Watcher watcher(relay.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  EXPECT_GT(mean(watcher.picture()), 0.1);
  // Who may change things here may not change them there
  ASSERT_TRUE(watcher.client().send(lamp(1, 0.0f)));
  const auto refusal = watcher.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::refused_input);
  EXPECT_GT(mean(watcher.picture(1)), 0.1);
  EXPECT_TRUE(light_from(relay).connected);
}

}  // namespace
}  // namespace lambent::stream::relay_test
