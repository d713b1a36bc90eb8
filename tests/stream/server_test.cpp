// SPDX-License-Identifier: Apache-2.0
// A server in this process, and clients that behave.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>

#include "core/image/metrics.h"
#include "core/image/tone_map.h"
#include "lambent/renderer.h"
#include "support/certificate.h"
#include "support/served_scene.h"
#include "support/temporary_directory.h"

namespace lambent::stream::server_test {
namespace {

using test::is_closed;
using test::next;
using test::ServedScene;
using test::small_hello;
using test::Watcher;

const std::string kLook = "looking-looking-looking", kEdit = "changing-changing-changing";

double mean(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += static_cast<double>(value);
  return sum / static_cast<double>(image.pixels.size());
}

double rmse(const Image& a, const Image& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = a.pixels[i] - b.pixels[i];
    squares += difference * difference;
  }
  return std::sqrt(squares / static_cast<double>(a.pixels.size()));
}

LightInput lamp_off(std::uint32_t input) {
  LightInput edit;
  edit.input = input;
  edit.edits = kEditsIntensity;
  return edit;
}

TEST(Server, SendsPicturesOfWhatTheLibraryRenders) {
  const ServedScene served;
  Watcher watcher(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(watcher.welcome().role, Role::change) << "on loopback, without tokens";
  EXPECT_EQ(watcher.welcome().lights.size(), 1u);
  Image sent;
  for (int i = 0; i < 5; ++i) sent = watcher.picture();
  ASSERT_EQ(sent.width, 64);
  ASSERT_EQ(sent.height, 64);

  const Scene scene = *scenes::make("cornell-spot");
  const World world(scene);
  auto field = *IrradianceField::make(ServedScene::small_field(), open_bounds(world));
  field.update(world);
  Renderer renderer(world, IndirectSources{&field});
  FrameSettings settings = ServedScene::small_settings().world.pictures.frame;
  settings.width = settings.height = 64;
  const auto frame = renderer.render(scene.cameras.front(), settings);
  ASSERT_TRUE(frame);
  const Image ours = display_image(*frame->image.find(""), ToneMap::aces, 0.0f);
  // Noise of one sample a pixel, and the codec's
  EXPECT_LT(rmse(sent, ours), 0.06);
  EXPECT_NEAR(mean(sent), mean(ours), 0.02);
  EXPECT_GT(mean(ours), 0.1);
}

TEST(Server, InputOfAClientChangesItsCameraAndNobodyElses) {
  const ServedScene served;
  Watcher one(served.address(), small_hello()), other(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  const Image before = other.picture();
  CameraInput away = one.welcome().camera;
  away.input = 1;
  away.position_ws.y = -1000.0f;  // where there is nothing
  ASSERT_TRUE(one.client().send(away));
  EXPECT_LT(mean(one.picture(1)), 0.05);
  EXPECT_NEAR(mean(other.picture()), mean(before), 0.02);
}

TEST(Server, AnEditOfOneClientIsSeenByAll) {
  const ServedScene served;
  Watcher one(served.address(), small_hello()), other(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  const double lit = mean(other.picture());
  EXPECT_GT(lit, 0.1);
  ASSERT_TRUE(one.client().send(lamp_off(1)));
  EXPECT_LT(mean(one.picture(1)), 0.01);
  // The other one sees the same state of the world, if not at once
  const std::uint64_t changed = one.state();
  Image seen = other.picture();
  while (!seen.empty() && other.state() < changed) seen = other.picture();
  ASSERT_FALSE(seen.empty());
  EXPECT_LT(mean(seen), 0.01);
}

TEST(Server, RefusesAnEditOfWhatIsNotThereAndGoesOn) {
  const ServedScene served;
  Watcher watcher(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  LightInput edit = lamp_off(1);
  edit.light = 99;
  ASSERT_TRUE(watcher.client().send(edit));
  const auto refusal = watcher.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::refused_input);
  ASSERT_TRUE(watcher.client().send(Ping{77, 0}));
  const auto answer = next<Ping>(watcher.client());
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->token, 77u);
  EXPECT_EQ(answer->answer, 1u);
}

TEST(Server, PicturesHaveTheSizeThatIsAskedForWithinTheLimits) {
  const ServedScene served;
  Hello large = small_hello();
  large.size = {640, 480};
  Watcher watcher(served.address(), large);
  ASSERT_FALSE(HasFailure());
  EXPECT_LE(watcher.picture().width, 320);
  ASSERT_TRUE(watcher.client().send(PictureRequest{{48, 32}, 30.0f}));
  Image image = watcher.picture();
  for (int i = 0; i < 5 && image.width != 48; ++i) image = watcher.picture();
  EXPECT_EQ(image.width, 48);
  EXPECT_EQ(image.height, 32);
}

TEST(Server, TellsHowItFares) {
  const ServedScene served;
  Watcher watcher(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  watcher.picture();
  const auto stats = next<ServerStats>(watcher.client());
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->clients, 1u);
  EXPECT_GT(stats->state, 0u);
  EXPECT_GT(stats->rate, 0.0f);
}

class WithTokens : public ::testing::Test {
 protected:
  void SetUp() override {
    write("view " + kLook + "\nchange " + kEdit + "\n");
    settings.listen.tokens = path;
  }
  void write(const std::string& text) const { std::ofstream(path) << text; }

  const test::TemporaryDirectory directory;
  const std::string path = directory.file("tokens");
  ServerSettings settings = ServedScene::small_settings();
};

TEST_F(WithTokens, OnlyWhoHasOneGetsInAndOnlyInItsRole) {
  const ServedScene served(settings);
  for (const std::string& wrong : {std::string(), std::string("guessed-guessed-guessed")}) {
    const auto joined = join(served.address(), small_hello(wrong));
    ASSERT_FALSE(joined);
    EXPECT_NE(joined.error().message().find("token"), std::string::npos);
  }
  Watcher looks(served.address(), small_hello(kLook)), edits(served.address(), small_hello(kEdit));
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(looks.welcome().role, Role::view);
  EXPECT_EQ(edits.welcome().role, Role::change);
  EXPECT_GT(mean(looks.picture()), 0.1);
  ASSERT_TRUE(looks.client().send(lamp_off(1)));
  const auto refusal = looks.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::not_allowed);
  EXPECT_TRUE(is_closed(looks.client()));
  EXPECT_GT(mean(edits.picture()), 0.1) << "the lamp is still on";
}

TEST_F(WithTokens, WhoseTokenIsRevokedIsSentAway) {
  const ServedScene served(settings);
  Watcher looks(served.address(), small_hello(kLook)), edits(served.address(), small_hello(kEdit));
  ASSERT_FALSE(HasFailure());
  write("change " + kEdit + "\n");
  const auto refusal = looks.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::bad_token);
  EXPECT_FALSE(edits.picture().empty());
}

TEST_F(WithTokens, ThatAreRepairedAreToldToBeGoodAgain) {
  std::mutex mutex;
  std::string said;
  settings.listen.log = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    said += line + "\n";
  };
  const auto says = [&](const std::string& words) {
    const auto end = std::chrono::steady_clock::now() + test::kPatience;
    while (std::chrono::steady_clock::now() < end) {
      {
        const std::lock_guard lock(mutex);
        if (said.find(words) != std::string::npos) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  };
  const ServedScene served(settings);
  write("nobody\n");
  ASSERT_TRUE(says("no token is good now"));
  write("change " + kEdit + "\n");
  EXPECT_TRUE(says("are good again"));
}

TEST(Server, IsReachedByItsIpv6Address) {
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.host = "::1";
  Hub hub(1, 1);
  if (const auto listener = Listener::open(settings.listen, hub); !listener) {
    GTEST_SKIP() << listener.error().message();
  }
  const ServedScene served(settings);
  ConnectSettings address = served.address();
  address.host = "::1";
  const auto joined = join(address, small_hello());
  EXPECT_TRUE(joined) << joined.error().message();
}

TEST(ServerTls, EncryptsAndIsKnownByItsCertificate) {
  const test::TemporaryDirectory directory;
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.certificate = directory.file("certificate.pem");
  settings.listen.key = directory.file("key.pem");
  ASSERT_TRUE(test::write_certificate(settings.listen.certificate, settings.listen.key));
  const ServedScene served(settings);
  ConnectSettings address = served.address();
  address.tls = true;
  address.host = "localhost";
  EXPECT_FALSE(join(address, small_hello())) << "nobody trusts it";
  address.authority = settings.listen.certificate;
  Watcher watcher(address, small_hello());
  ASSERT_FALSE(HasFailure());
  EXPECT_GT(mean(watcher.picture()), 0.1);
  address.tls = false;
  EXPECT_FALSE(join(address, small_hello())) << "it speaks TLS alone";
  address.tls = true;
  address.host = "127.0.0.1";
  EXPECT_FALSE(join(address, small_hello())) << "the certificate is of another name";
}

TEST(ServerStart, FailsWithTheCauseWhereItCannotListen) {
  const ServedScene first;
  Hub hub(1, 1);
  ListenSettings settings;
  settings.port = first.port();
  const auto taken = Listener::open(settings, hub);
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().message().find("in use"), std::string::npos);
  EXPECT_EQ(taken.error().kind, Error::Kind::failed);

  settings.port = 0;
  settings.host = "0.0.0.0";
  const auto open = Listener::open(settings, hub);
  ASSERT_FALSE(open) << "everybody could change the scene";
  EXPECT_NE(open.error().message().find("tokens"), std::string::npos);

  settings.host = "no.such.host.invalid";
  settings.tokens = "/nowhere/tokens";
  EXPECT_FALSE(Listener::open(settings, hub));
  settings = {};
  settings.port = 0;
  settings.certificate = settings.key = "/nowhere/certificate";
  EXPECT_FALSE(Listener::open(settings, hub));
}

TEST(Server, SaysFarewellWhenItEnds) {
  ServedScene served;
  Watcher watcher(served.address(), small_hello());
  ASSERT_FALSE(HasFailure());
  watcher.picture();
  std::thread ends([&] { EXPECT_TRUE(served.stop()); });
  const auto refusal = watcher.refusal();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::shutting_down);
  EXPECT_TRUE(is_closed(watcher.client()));
  ends.join();
}

}  // namespace
}  // namespace lambent::stream::server_test
