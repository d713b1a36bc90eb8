// SPDX-License-Identifier: Apache-2.0
// What a server and its clients tell each other, in bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "stream/protocol/messages.h"
#include "support/protocol_messages.h"

namespace lambent::stream::protocol_test {
namespace {

using ::testing::HasSubstr;

std::vector<std::byte> with_word(std::vector<std::byte> bytes, std::size_t at, std::uint32_t word) {
  std::memcpy(bytes.data() + at, &word, sizeof word);
  return bytes;
}

std::vector<std::byte> with_real(std::vector<std::byte> bytes, std::size_t at, float value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}

TEST(Protocol, MessagesComeOutAsTheyWentIn) {
  for (const auto& [message, sender] : test::one_of_each_message()) {
    const std::vector<std::byte> bytes = write_message(message);
    const auto read = parse_message(bytes, sender);
    ASSERT_TRUE(read) << message.index() << ": " << read.error().message();
    EXPECT_EQ(read->index(), message.index());
    EXPECT_EQ(write_message(*read), bytes) << message.index();
  }
}

TEST(Protocol, FieldsComeOutAsTheyWentIn) {
  LightInput edit;
  edit.input = 7;
  edit.light = 3;
  edit.edits = kEditsPosition | kEditsIntensity;
  edit.position_ws = {1.0f, -2.0f, 3.5f};
  edit.intensity = {10.0f, 20.0f, 30.0f};
  const auto read = parse_message(write_message(edit), Sender::client);
  ASSERT_TRUE(read);
  const auto& same = std::get<LightInput>(*read);
  EXPECT_EQ(same.input, 7u);
  EXPECT_EQ(same.light, 3u);
  EXPECT_EQ(same.edits, kEditsPosition | kEditsIntensity);
  EXPECT_EQ(same.position_ws, edit.position_ws);
  EXPECT_EQ(same.intensity, edit.intensity);
}

TEST(Protocol, MessagesOfClientsAreSmall) {
  for (const auto& [message, sender] : test::one_of_each_message()) {
    if (sender == Sender::client) {
      EXPECT_LE(write_message(message).size(), kMaxClientMessageBytes) << message.index();
    }
  }
}

TEST(Protocol, MessagesThatAreCutOffOrTooLongAreRefused) {
  for (const auto& [message, sender] : test::one_of_each_message()) {
    const std::vector<std::byte> whole = write_message(message);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(parse_message(cut, sender)) << message.index() << " cut to " << size;
      if (size < kHeaderBytes) continue;
      // With a size in the header that agrees
      cut = with_word(cut, 4, static_cast<std::uint32_t>(size - kHeaderBytes));
      EXPECT_FALSE(parse_message(cut, sender)) << message.index() << " cut to " << size;
    }
    // With one that does not agree, though all is there
    const auto body = static_cast<std::uint32_t>(whole.size() - kHeaderBytes);
    for (const std::uint32_t wrong : {body - 1, body + 1, 0xffffffffu}) {
      EXPECT_FALSE(parse_message(with_word(whole, 4, wrong), sender)) << message.index();
    }
    std::vector<std::byte> longer = whole;
    longer.push_back(std::byte{0});
    EXPECT_FALSE(parse_message(longer, sender)) << message.index();
    longer = with_word(longer, 4, static_cast<std::uint32_t>(longer.size() - kHeaderBytes));
    EXPECT_FALSE(parse_message(longer, sender)) << message.index();
  }
}

TEST(Protocol, EachSideRefusesWhatOnlyTheOtherOneSends) {
  for (const auto& [message, sender] : test::one_of_each_message()) {
    const Sender other = sender == Sender::client ? Sender::server : Sender::client;
    const bool of_both =
        std::holds_alternative<Ping>(message) || std::holds_alternative<TimeOfDay>(message) ||
        std::holds_alternative<SunInput>(message) || std::holds_alternative<LightInput>(message) ||
        std::holds_alternative<ObjectInput>(message);
    EXPECT_EQ(parse_message(write_message(message), other).has_value(), of_both) << message.index();
  }
  const std::vector<std::byte> ping = write_message(Ping{});
  for (const std::uint32_t type : {0u, 6u, 31u, 37u, 70u, 255u, 256u + 32u, 0xffffffffu}) {
    EXPECT_FALSE(parse_message(with_word(ping, 0, type), Sender::client)) << type;
    EXPECT_FALSE(parse_message(with_word(ping, 0, type), Sender::server)) << type;
  }
}

TEST(Protocol, NumbersThatAreNotFiniteAreRefusedWhereverTheyStand) {
  const float inf = std::numeric_limits<float>::infinity();
  // All that follows the number of the input is a real
  for (const Message& message :
       {Message(CameraInput{}), Message(TimeOfDay{}), Message(SunInput{})}) {
    const std::vector<std::byte> fine = write_message(message);
    for (std::size_t at = kHeaderBytes + 4; at < fine.size(); at += 4) {
      for (const float bad : {std::nanf(""), inf, -inf}) {
        EXPECT_FALSE(parse_message(with_real(fine, at, bad), Sender::client))
            << message.index() << " at " << at;
      }
    }
  }
}

TEST(Protocol, NumbersOutOfRangeAreRefusedByName) {
  const auto cause = [](const std::vector<std::byte>& bytes) {
    const auto read = parse_message(bytes, Sender::client);
    return read ? std::string("was read") : read.error().message();
  };
  const std::vector<std::byte> hello = write_message(Hello{});
  EXPECT_THAT(cause(with_word(hello, kHeaderBytes, 1)), HasSubstr("magic"));
  EXPECT_THAT(cause(with_word(hello, kHeaderBytes + 8, 8)), HasSubstr("wants"));
  EXPECT_THAT(cause(with_word(hello, kHeaderBytes + 12, 100'000)), HasSubstr("width"));
  EXPECT_THAT(cause(with_word(hello, kHeaderBytes + 16, 0)), HasSubstr("height"));
  EXPECT_THAT(cause(with_word(hello, kHeaderBytes + 24, 0xffffffff)), HasSubstr("token"));
  const std::vector<std::byte> camera = write_message(CameraInput{});
  EXPECT_THAT(cause(with_real(camera, kHeaderBytes + 4, 2e9f)), HasSubstr("position"));
  EXPECT_THAT(cause(with_real(camera, kHeaderBytes + 28, 0.5f)), HasSubstr("rotation"));
  EXPECT_THAT(cause(with_real(camera, kHeaderBytes + 32, 3.2f)), HasSubstr("fov"));
  EXPECT_THAT(cause(with_real(write_message(TimeOfDay{}), kHeaderBytes + 4, 24.5f)),
              HasSubstr("hours"));
  EXPECT_THAT(cause(with_word(write_message(LightInput{}), kHeaderBytes + 8, 0)),
              HasSubstr("edits"));
}

TEST(Protocol, FilesOfTheFuzzCorpusAreReadByOneSide) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(LAMBENT_FUZZ_CORPUS) + "/protocol")) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)),
                           std::istreambuf_iterator<char>());
    const auto bytes = std::as_bytes(std::span(text));
    EXPECT_TRUE(parse_message(bytes, Sender::client) || parse_message(bytes, Sender::server))
        << entry.path();
    ++files;
  }
  EXPECT_GE(files, 15);
}

}  // namespace
}  // namespace lambent::stream::protocol_test
