// SPDX-License-Identifier: Apache-2.0
// Sessions: written, read, and played to another server.
#include "stream/session/session_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "core/files/file_bytes.h"
#include "core/little_endian.h"
#include "stream/session/replay.h"
#include "support/served_scene.h"
#include "support/temporary_directory.h"

namespace lambent::stream::session_test {
namespace {

using std::chrono::microseconds;
using test::next;
using test::ServedScene;

LightInput lamp(std::uint32_t input, float share) {
  LightInput edit;
  edit.input = input;
  edit.edits = kEditsIntensity;
  edit.intensity = share * scenes::make("cornell-spot")->lights[0].intensity;
  return edit;
}

/// The messages of each client in their order, as bytes.
std::map<std::uint32_t, std::vector<std::vector<std::byte>>> said(
    const std::vector<SessionEntry>& entries) {
  std::map<std::uint32_t, std::vector<std::vector<std::byte>>> all;
  for (const SessionEntry& entry : entries) {
    all[entry.client].push_back(entry.message ? write_message(*entry.message)
                                              : std::vector<std::byte>());
  }
  return all;
}

class SessionFile : public ::testing::Test {
 protected:
  /// Writes these; false where one could not be.
  [[nodiscard]] bool write(const std::vector<SessionEntry>& entries) const {
    auto writer = SessionWriter::create(path);
    if (!writer) return false;
    for (const SessionEntry& entry : entries) {
      if (!writer->add(entry)) return false;
    }
    return true;
  }
  std::string why_not() const {
    const auto read = read_session(path);
    return read ? "it was read" : read.error().message();
  }

  const test::TemporaryDirectory directory;
  const std::string path = directory.file("session");
  const SessionEntry hello{microseconds(5), 1, Hello{}};
};

TEST_F(SessionFile, KeepsWhatWasSaidAndWhenWithoutTokens) {
  Hello secret;
  secret.wants = kWantsLight;
  secret.token = "changing-changing-changing";
  CameraInput camera;
  camera.input = 3;
  const std::vector<SessionEntry> entries = {{microseconds(0), 1, secret},
                                             {microseconds(7), 2, Hello{}},
                                             {microseconds(8), 1, lamp(1, 0.5f)},
                                             {microseconds(8), 2, camera},
                                             {microseconds(1'000'000), 1, std::nullopt},
                                             {microseconds(1'000'001), 2, TimeOfDay{4, 7.5f}}};
  ASSERT_TRUE(write(entries));
  const auto read = read_session(path);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ((*read)[i].time, entries[i].time);
    EXPECT_EQ((*read)[i].client, entries[i].client);
  }
  EXPECT_TRUE(std::get<Hello>(*read->front().message).token.empty());
  EXPECT_EQ(std::get<Hello>(*read->front().message).wants, kWantsLight);
  EXPECT_EQ(std::get<TimeOfDay>(*read->back().message).hours, 7.5f);
  const auto bytes = read_file(path);
  ASSERT_TRUE(bytes);
  const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  EXPECT_EQ(text.find("changing"), std::string::npos);
}

TEST_F(SessionFile, OfAServerThatWasKilledIsReadUpToThere) {
  ASSERT_TRUE(write({hello, {microseconds(6), 1, lamp(1, 1.0f)}}));
  const auto whole = read_file(path);
  ASSERT_TRUE(whole);
  for (std::size_t size = 8; size < whole->size(); ++size) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(whole->data()), static_cast<std::streamsize>(size));
    const auto read = read_session(path);
    ASSERT_TRUE(read) << size << ": " << read.error().message();
    EXPECT_LE(read->size(), 1u);
  }
}

TEST_F(SessionFile, ThatNoServerWroteIsRefused) {
  const auto refuses = [&](const std::vector<SessionEntry>& entries) {
    EXPECT_TRUE(write(entries));
    return why_not().find("nothing that a server wrote") != std::string::npos;
  };
  EXPECT_TRUE(refuses({{microseconds(5), 1, lamp(1, 1.0f)}})) << "without a hello";
  EXPECT_TRUE(refuses({hello, hello})) << "twice";
  EXPECT_TRUE(refuses({hello, {microseconds(4), 1, lamp(1, 1.0f)}})) << "before the last";
  EXPECT_TRUE(refuses({hello, {microseconds(6), 1, {}}, {microseconds(7), 1, lamp(1, 1.0f)}}));
  EXPECT_TRUE(refuses({hello, {microseconds(6), 1, Ping{1, 0}}})) << "an answer";

  ASSERT_TRUE(write({hello}));
  auto bytes = *read_file(path);
  const auto with = [&](std::size_t at, unsigned char value) {
    auto changed = bytes;
    changed[at] = std::byte{value};
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(changed.data()),
               static_cast<std::streamsize>(changed.size()));
    return why_not();
  };
  EXPECT_NE(with(0, 0).find("no session"), std::string::npos);
  EXPECT_NE(with(4, 9).find("version 9"), std::string::npos);
  EXPECT_NE(with(21, 9).find("larger than any"), std::string::npos);
  EXPECT_NE(with(24, 77).find("entry 1"), std::string::npos) << "no message of a client's";
  EXPECT_FALSE(read_session(directory.file("missing")));
  EXPECT_FALSE(SessionWriter::create(directory.file("no/such/folder")));
}

TEST(SessionReplay, GivesAnotherServerTheSameEditsAndLeavesItsSceneTheSame) {
  const test::TemporaryDirectory directory;
  ServerSettings settings = ServedScene::small_settings();
  settings.listen.record = directory.file("first");
  ServedScene first(settings);
  {
    auto looks = join(first.address(), test::small_hello());
    Hello of_light;
    of_light.wants = kWantsLight;
    auto edits = join(first.address(), of_light);
    ASSERT_TRUE(looks && edits);
    for (std::uint32_t i = 1; i <= 5; ++i) {
      ASSERT_TRUE(edits->client->send(lamp(i, 0.1f * static_cast<float>(i))));
    }
    CameraInput camera = looks->welcome.camera;
    camera.input = 1;
    ASSERT_TRUE(looks->client->send(camera));
    ObjectInput moved;
    moved.input = 2;
    moved.instance = looks->welcome.instances - 1;
    moved.world_from_object = glm::mat4x3(1.0f);
    moved.world_from_object[3] = {1.0f, 2.0f, 0.5f};
    ASSERT_TRUE(looks->client->send(moved));
    ASSERT_TRUE(next<InputsApplied>(*edits->client));
    edits->client->close();
    const auto picture = [&] {
      auto shown = next<Picture>(*looks->client);
      while (shown && shown->input < 2) {
        EXPECT_TRUE(looks->client->send(Received{shown->number, 0.0f}));
        shown = next<Picture>(*looks->client);
      }
      return shown;
    }();
    ASSERT_TRUE(picture);
    looks->client->close();
  }
  ASSERT_TRUE(first.stop());
  const auto session = read_session(settings.listen.record);
  ASSERT_TRUE(session) << session.error().message();

  ServerSettings again = settings;
  again.listen.record = directory.file("second");
  ServedScene second(again);
  ReplaySettings how;
  how.connect = second.address();
  how.connect.timeout = test::kPatience;
  const auto replayed = replay_session(*session, how);
  ASSERT_TRUE(replayed) << replayed.error().message();
  ASSERT_TRUE(second.stop());
  EXPECT_EQ(replayed->clients, 2u);
  EXPECT_EQ(replayed->messages, 7u);
  EXPECT_EQ(replayed->refused_inputs, 0u);
  EXPECT_GT(replayed->pictures, 0u);

  const auto played = read_session(again.listen.record);
  ASSERT_TRUE(played);
  EXPECT_EQ(said(*played), said(*session));
  EXPECT_EQ(second.scene().lights[0].intensity, first.scene().lights[0].intensity);
  EXPECT_EQ(second.scene().lights[0].intensity, lamp(0, 0.5f).intensity);
  EXPECT_EQ(second.scene().instances.back().world_from_object,
            first.scene().instances.back().world_from_object);
  EXPECT_NE(second.scene().instances.back().world_from_object,
            scenes::make("cornell-spot")->instances.back().world_from_object);
}

TEST(SessionReplay, FailsWhereTheServerRefuses) {
  ServerSettings full = ServedScene::small_settings();
  full.max_clients = 1;
  const ServedScene served(full);
  const std::vector<SessionEntry> two = {{microseconds(0), 1, Hello{}},
                                         {microseconds(0), 2, Hello{}}};
  ReplaySettings how;
  how.connect = served.address();
  const auto replayed = replay_session(two, how);
  ASSERT_FALSE(replayed);
  EXPECT_NE(replayed.error().message().find("as many clients as may be"), std::string::npos);
}

}  // namespace
}  // namespace lambent::stream::session_test
