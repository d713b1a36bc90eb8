// SPDX-License-Identifier: Apache-2.0
// Light to clients that render their own copy of the scene.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "core/image/tone_map.h"
#include "lambent/renderer.h"
#include "stream/client/lit_scene.h"
#include "stream/server/light_sender.h"
#include "support/served_scene.h"

namespace lambent::stream::light_test {
namespace {

using test::ServedScene;

// Of the light, within which whatever is sent has come.
constexpr int kUpdates = 200;

Hello light_hello() {
  Hello hello;
  hello.wants = kWantsLight;
  return hello;
}

/// A client with a scene of its own.
class LightClient {
 public:
  explicit LightClient(const ConnectSettings& address)
      : scene_(*scenes::make("cornell-spot")), world_(scene_), lit_(scene_, world_) {
    auto joined = join(address, light_hello());
    if (!joined) {
      ADD_FAILURE() << joined.error().message();
      return;
    }
    client_ = std::move(joined->client);
  }

  Client& client() { return *client_; }
  LitScene& lit() { return lit_; }
  const Scene& scene() const { return scene_; }

  /// Takes messages until there is other light; false where none comes.
  bool follow() {
    const auto end = std::chrono::steady_clock::now() + test::kPatience;
    while (std::chrono::steady_clock::now() < end) {
      const auto message = client_->receive(std::chrono::milliseconds(100));
      if (!message) return false;
      if (!*message) continue;
      const auto followed = lit_.follow(**message);
      EXPECT_TRUE(followed);
      if (!followed) return false;
      if (followed->answer && !client_->send(*followed->answer)) return false;
      if (followed->lit) return true;
    }
    return false;
  }

  /// Indirect irradiance at some places of the box.
  std::vector<glm::vec3> light() const {
    std::vector<FieldQuery> queries;
    for (const float y : {0.5f, 2.5f, 4.5f}) {
      for (const glm::vec3 normal : {glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(0.0f, -1.0f, 0.0f),
                                     glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(-1.0f, 0.0f, 0.0f)}) {
        queries.push_back({{2.75f, y, 1.0f}, normal, normal});
      }
    }
    std::vector<glm::vec3> result(queries.size());
    lit_.field()->irradiance(queries, result);
    return result;
  }

  Image picture() {
    Renderer renderer(world_, IndirectSources{lit_.field()});
    FrameSettings settings = ServedScene::small_settings().world.pictures.frame;
    settings.width = settings.height = 64;
    const auto frame = renderer.render(scene_.cameras.front(), settings);
    return display_image(*frame->image.find(""), ToneMap::aces, 0.0f);
  }

 private:
  Scene scene_;
  World world_;
  LitScene lit_;
  std::unique_ptr<Client> client_;
};

double mean(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += static_cast<double>(value);
  return sum / static_cast<double>(image.pixels.size());
}

double mean(const std::vector<glm::vec3>& light) {
  double sum = 0.0;
  for (const glm::vec3& one : light) sum += static_cast<double>(one.x + one.y + one.z);
  return sum / static_cast<double>(3 * light.size());
}

LightInput lamp(std::uint32_t input, float share) {
  LightInput edit;
  edit.input = input;
  edit.edits = kEditsIntensity;
  edit.intensity = share * scenes::make("cornell-spot")->lights[0].intensity;
  return edit;
}

TEST(LightStream, ComesByRegionsToWhoCaresForSomeOfIt) {
  const ServedScene served;
  LightClient all(served.address()), some(served.address());
  ASSERT_FALSE(HasFailure());
  CameraInput camera;
  camera.input = 1;
  camera.position_ws = {2.75f, 2.5f, 1.0f};
  ASSERT_TRUE(some.client().send(camera));
  ASSERT_TRUE(some.client().send(Interest{2.0f}));
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(some.follow());
  EXPECT_FALSE(some.lit().decoder().join()) << "it is no whole stream";
  while (all.lit().update() < some.lit().update()) ASSERT_TRUE(all.follow());
  while (some.lit().update() < all.lit().update()) ASSERT_TRUE(some.follow());
  ASSERT_EQ(all.lit().update(), some.lit().update());
  EXPECT_EQ(all.light(), some.light()) << "the box is one region, which is near";
  // And all of it again
  ASSERT_TRUE(some.client().send(Interest{0.0f}));
  for (int i = 0; i < kUpdates && !some.lit().decoder().join(); ++i) ASSERT_TRUE(some.follow());
  EXPECT_TRUE(some.lit().decoder().join());
}

TEST(LightStream, LightsACopyOfTheSceneAsTheServerDoes) {
  const ServedScene served;
  LightClient client(served.address());
  test::Watcher watcher(served.address(), test::small_hello());
  ASSERT_FALSE(HasFailure());
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(client.follow());
  Image sent;
  for (int i = 0; i < 3; ++i) sent = watcher.picture();
  ASSERT_FALSE(sent.empty());
  const Image ours = client.picture();
  EXPECT_GT(mean(client.light()), 0.0);
  EXPECT_GT(mean(ours), 0.1);
  EXPECT_NEAR(mean(ours), mean(sent), 0.02);
}

TEST(LightStream, EditsOfOthersReachTheCopyWithTheirLight) {
  const ServedScene served;
  LightClient client(served.address());
  auto editor = join(served.address(), test::small_hello());
  ASSERT_TRUE(editor);
  // Until the light has settled: on a machine under load an update traces few probes
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(client.follow());
  const double before = mean(client.light());
  ASSERT_TRUE(editor->client->send(lamp(1, 0.25f)));
  const glm::vec3 dimmed = 0.25f * scenes::make("cornell-spot")->lights[0].intensity;
  for (int i = 0; i < kUpdates && client.scene().lights[0].intensity != dimmed; ++i) {
    ASSERT_TRUE(client.follow());
  }
  ASSERT_EQ(client.scene().lights[0].intensity, dimmed);
  // Some updates may be under way that were made before
  EXPECT_NEAR(mean(client.light()), 0.25 * before, 0.03 * before);
}

TEST(LightStream, WhoComesLateGetsAllThatWasEdited) {
  const ServedScene served;
  auto editor = join(served.address(), test::small_hello());
  ASSERT_TRUE(editor);
  ASSERT_TRUE(editor->client->send(lamp(1, 0.5f)));
  ObjectInput moved;
  moved.input = 2;
  moved.instance = static_cast<std::uint32_t>(served.scene().instances.size()) - 1;
  const glm::mat4 place =
      glm::translate(scenes::make("cornell-spot")->instances.back().world_from_object,
                     glm::vec3(0.1f, 0.0f, 0.0f));
  moved.world_from_object = glm::mat4x3(place);
  ASSERT_TRUE(editor->client->send(moved));
  ASSERT_TRUE(editor->client->send(Ping{}));
  ASSERT_TRUE(test::next<Ping>(*editor->client));
  ASSERT_TRUE(test::next<ServerStats>(*editor->client)) << "an update later";

  LightClient late(served.address());
  ASSERT_FALSE(HasFailure());
  ASSERT_TRUE(late.follow());
  EXPECT_EQ(late.scene().lights[0].intensity,
            0.5f * scenes::make("cornell-spot")->lights[0].intensity);
  EXPECT_EQ(late.scene().instances.back().world_from_object, glm::mat4(glm::mat4x3(place)));
}

TEST(LightStream, WhoFallsBehindBeginsAgainWithTheLatest) {
  const ServedScene served;
  LightClient slow(served.address());
  auto watching = join(served.address(), test::small_hello());
  ASSERT_TRUE(watching);
  ASSERT_TRUE(slow.follow());
  const std::uint64_t before = slow.lit().update();
  // It reads nothing for long enough that its window is full
  const std::uint64_t enough = before + ClientLink::kMostUpdatesUnderWay;
  for (std::uint64_t state = 0; state < enough + 10;) {
    const auto stats = test::next<ServerStats>(*watching->client);
    ASSERT_TRUE(stats);
    state = stats->state;
  }
  // Then it catches up with what was under way, and goes on from a key
  for (int i = 0; i < kUpdates && slow.lit().update() < enough; ++i) ASSERT_TRUE(slow.follow());
  EXPECT_GE(slow.lit().update(), enough);
  EXPECT_GT(mean(slow.light()), 0.0);
}

/// All that waits for a client, parsed.
std::vector<Message> taken_from(ClientLink& link) {
  std::vector<Message> messages;
  while (const SharedBytes bytes = link.next({})) {
    const auto message = parse_message(*bytes, Sender::server);
    EXPECT_TRUE(message);
    if (message) messages.push_back(*message);
  }
  return messages;
}

TEST(LightSender, SendsEditsBeforeTheLightThatFollowedToThoseWhoFollowAndThoseWhoBegin) {
  const Scene scene = *scenes::make("cornell-spot");
  const World world(scene);
  auto field = *IrradianceField::make(ServedScene::small_field(), open_bounds(world));
  auto sender = LightSender::make({});
  ASSERT_TRUE(sender);
  ClientLink follows(
      light_hello(), Role::view, [] {}, [] {});
  ClientLink late(
      light_hello(), Role::view, [] {}, [] {});
  const std::array<ClientLink*, 1> one = {&follows};
  const std::array<ClientLink*, 2> both = {&follows, &late};
  field.update(world);
  ASSERT_TRUE(sender->send(field, 1.5f, one));
  const std::vector<Message> first = taken_from(follows);
  ASSERT_FALSE(first.empty());
  EXPECT_EQ(std::get<LightPayload>(first.front()).time_s, 1.5f);

  sender->add_edit(lamp(9, 0.5f));
  field.update(world);
  ASSERT_TRUE(sender->send(field, 1.6f, one));
  const std::vector<Message> second = taken_from(follows);
  ASSERT_GE(second.size(), 2u);
  EXPECT_EQ(std::get<LightInput>(second.front()).input, 0u) << "the number is the sender's own";
  EXPECT_TRUE(std::holds_alternative<LightPayload>(second.back()));

  field.update(world);
  ASSERT_TRUE(sender->send(field, 1.7f, both));
  EXPECT_TRUE(std::holds_alternative<LightPayload>(taken_from(follows).front())) << "it has it";
  EXPECT_TRUE(std::holds_alternative<LightInput>(taken_from(late).front()));
}

class LightLink : public ::testing::Test {
 protected:
  void put(std::uint64_t update, LightNeed what) {
    const SharedBytes bytes = std::make_shared<const std::vector<std::byte>>(100);
    link.put_light({&bytes, 1}, update, what);
  }
  void answer(std::uint64_t update, std::uint32_t needs_key) {
    EXPECT_FALSE(link.receive(LightReceived{update, 1, needs_key}, {}));
  }

  ClientLink link{light_hello(), Role::view, [] {}, [] {}};
};

TEST_F(LightLink, BeginsWithAllAndGoesOnWithChanges) {
  EXPECT_EQ(link.need_light(), LightNeed::all);
  put(5, LightNeed::all);
  ASSERT_TRUE(link.next({}));
  EXPECT_EQ(link.need_light(), LightNeed::changes);
  put(6, LightNeed::changes);
  EXPECT_EQ(link.need_light(), LightNeed::changes) << "one waits to be written, and is followed";
  ASSERT_TRUE(link.next({}));
  EXPECT_EQ(link.need_light(), LightNeed::changes);
}

TEST_F(LightLink, NoMoreUpdatesAreUnderWayThanTheWindow) {
  std::uint64_t update = 1;
  for (; update <= ClientLink::kUpdatesUnderWay; ++update) {
    ASSERT_NE(link.need_light(), LightNeed::nothing);
    put(update, update == 1 ? LightNeed::all : LightNeed::changes);
    ASSERT_TRUE(link.next({}));
  }
  EXPECT_EQ(link.need_light(), LightNeed::nothing);
  answer(3, 0);
  EXPECT_EQ(link.need_light(), LightNeed::all);
}

TEST_F(LightLink, WaitsForWhatWasLostWhereThatIsShorterThanABeginning) {
  const auto put_bytes = [&](std::uint64_t update, LightNeed what, std::size_t bytes) {
    const SharedBytes message = std::make_shared<const std::vector<std::byte>>(bytes);
    link.put_light({&message, 1}, update, what);
  };
  put_bytes(1, LightNeed::all, 10'000);
  answer(1, 0);
  std::uint64_t update = 2;
  for (; link.need_light() == LightNeed::changes; ++update) {
    put_bytes(update, LightNeed::changes, 300);
  }
  EXPECT_EQ(update - 2, 17u) << "half of what it began with";
  // And however small they are
  answer(update, 0);
  put_bytes(update, LightNeed::all, 1'000'000);
  std::uint64_t last = update + 1;
  for (; link.need_light() == LightNeed::changes; ++last) put_bytes(last, LightNeed::changes, 1);
  EXPECT_EQ(last - update, ClientLink::kMostUpdatesUnderWay);
}

TEST_F(LightLink, WritesWhatCanWaitAfterAllElse) {
  const auto of_size = [](std::size_t bytes) {
    return SharedBytes(std::make_shared<const std::vector<std::byte>>(bytes));
  };
  put(5, LightNeed::all);
  EXPECT_FALSE(link.has_all());
  const std::array<SharedBytes, 3> later = {of_size(1), of_size(2), of_size(3)};
  link.put_later(later, true);
  EXPECT_EQ(link.next({})->size(), 100u);
  EXPECT_EQ(link.next({})->size(), 1u);
  put(6, LightNeed::changes);
  EXPECT_EQ(link.next({})->size(), 100u) << "light does not wait for it";
  EXPECT_FALSE(link.has_all());
  // Others take the place of what still waits
  const std::array<SharedBytes, 1> other = {of_size(4)};
  link.put_later(other, true);
  link.put_later(later, false);
  EXPECT_EQ(link.waiting_bytes(), 10u);
  for (const std::size_t size : {4u, 1u, 2u, 3u}) EXPECT_EQ(link.next({})->size(), size);
  EXPECT_FALSE(link.next({}));
  EXPECT_TRUE(link.has_all());
  link.put_later(later, false);
  link.begin_light_anew();
  EXPECT_FALSE(link.next({})) << "of another stream";
}

TEST(LightSender, SendsCorrectionsAfterTheLight) {
  const Scene scene = *scenes::make("cornell-spot");
  const World world(scene);
  auto field = *IrradianceField::make(ServedScene::corrected_field(), open_bounds(world));
  auto sender = LightSender::make({});
  ASSERT_TRUE(sender);
  const std::array<std::unique_ptr<ClientLink>, 2> links = {
      std::make_unique<ClientLink>(
          light_hello(), Role::view, [] {}, [] {}),
      std::make_unique<ClientLink>(
          light_hello(), Role::view, [] {}, [] {})};
  std::array<ClientLink*, 1> first = {links[0].get()}, second = {links[1].get()};
  const auto kinds_of = [](ClientLink& link) {
    std::vector<LightMessageKind> kinds;
    for (const Message& message : taken_from(link)) {
      const auto* light = std::get_if<LightPayload>(&message);
      if (light != nullptr) kinds.push_back(static_cast<LightMessageKind>(light->kind));
    }
    return kinds;
  };
  for (int update = 0; update < 4; ++update) field.update(world);
  ASSERT_TRUE(sender->send(field, 0.0f, first));
  const std::vector<LightMessageKind> begun = {LightMessageKind::geometry, LightMessageKind::key,
                                               LightMessageKind::corrections};
  EXPECT_EQ(kinds_of(*links[0]), begun);
  ASSERT_TRUE(sender->greet(field, 0.0f, second));
  EXPECT_EQ(kinds_of(*links[1]), begun);
  // Those that are learned later go to all, once
  std::size_t again = 0;
  for (int update = 0; update < 20; ++update) {
    field.update(world);
    ASSERT_TRUE(sender->send(field, 0.0f, first));
    const auto kinds = kinds_of(*links[0]);
    again += static_cast<std::size_t>(
        std::count(kinds.begin(), kinds.end(), LightMessageKind::corrections));
    const std::uint64_t taken = sender->next_update(*links[0]) - 1;
    EXPECT_FALSE(links[0]->receive(LightReceived{taken, 0, 0}, {}));
  }
  EXPECT_EQ(again, 1u);
}

TEST_F(LightLink, AKeyThatIsAskedForIsSentOnce) {
  link.need_light();
  put(5, LightNeed::all);
  ASSERT_TRUE(link.next({}));
  answer(5, 0);
  EXPECT_EQ(link.need_light(), LightNeed::changes);
  answer(5, 1);
  EXPECT_EQ(link.need_light(), LightNeed::all);
  put(7, LightNeed::all);
  ASSERT_TRUE(link.next({}));
  answer(6, 1);  // said before the key came
  EXPECT_EQ(link.need_light(), LightNeed::changes);
}

}  // namespace
}  // namespace lambent::stream::light_test
