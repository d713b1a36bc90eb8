// SPDX-License-Identifier: Apache-2.0
// Bodies of the messages of a light stream, from made-up states.
#include "stream/light/light_coding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/files/file_bytes.h"
#include "stream/light/geometry_coding.h"
#include "support/light_fuzz.h"
#include "support/light_states.h"

namespace lambent::stream::light_coding_test {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kPlenty = std::size_t{1} << 30;

/// A geometry that is in one part.
std::vector<std::byte> written(const FieldGeometry& geometry) {
  GeometrySections sections;
  const auto parts = write_geometry(geometry, sections);
  EXPECT_EQ(parts.size(), 1u);
  return parts.front();
}

bool same_geometry(const FieldGeometry& a, const FieldGeometry& b) {
  if (!a.same_kind(b) || a.offsets != b.offsets || a.states != b.states || a.moments != b.moments ||
      !std::equal(a.corrections.begin(), a.corrections.end(), b.corrections.begin(),
                  b.corrections.end(), [](const auto& x, const auto& y) {
                    return is_same_block(x.key, y.key) && x.cells == y.cells;
                  })) {
    return false;
  }
  for (std::size_t v = 0; v < a.volumes.size(); ++v) {
    if (!same_place(a.volumes[v].grid, b.volumes[v].grid) ||
        a.volumes[v].grid.first != b.volumes[v].grid.first) {
      return false;
    }
  }
  return true;
}

TEST(LightCoding, LeadsBothSidesToTheSameStateOverManyUpdates) {
  for (const int texels : {4, 16, 64, 256}) {
    const LightLayout layout = test::made_layout(texels);
    LightState sent = test::dark_state(layout), received = sent;
    std::mt19937 random(texels);
    std::vector<std::int32_t> levels;
    for (int update = 0; update < 30; ++update) {
      const auto wanted = test::made_levels(layout, random);
      const std::vector<std::byte> body = write_delta(layout, wanted, sent);
      const Expected<void> fine = read_delta(layout, body, received, levels);
      ASSERT_TRUE(fine) << fine.error().message();
      ASSERT_EQ(levels, wanted);
      ASSERT_EQ(received, sent);
    }
    EXPECT_EQ(sent.update, 31u);
  }
}

TEST(LightCoding, KeysHoldAllThatDeltasFollowOn) {
  const LightLayout layout = test::made_layout(16);
  LightState state = test::dark_state(layout);
  std::mt19937 random(1);
  for (int update = 0; update < 20; ++update) {
    write_delta(layout, test::made_levels(layout, random), state);
  }
  Expected<LightState> joined = read_key(layout, write_key(layout, state));
  ASSERT_TRUE(joined) << joined.error().message();
  joined->update = state.update;
  EXPECT_EQ(*joined, state);
}

TEST(LightCoding, SaysNothingInNextToNoBytes) {
  const LightLayout layout = test::made_layout(16);
  LightState state = test::dark_state(layout);
  const std::vector<std::int32_t> nothing(state.coefficients.size());
  for (int i = 0; i < 20; ++i) write_delta(layout, nothing, state);
  EXPECT_LE(write_delta(layout, nothing, state).size(), 2u);
}

TEST(LightCoding, HoldsTheLargestNumbers) {
  const LightLayout layout = test::made_layout(16);
  LightState sent = test::dark_state(layout), received = sent;
  std::vector<std::int32_t> levels(sent.coefficients.size()), read;
  levels[16 * 3 * 3] = kMaxCoefficient;
  levels[16 * 3 * 3 + 5] = -kMaxCoefficient;
  ASSERT_TRUE(read_delta(layout, write_delta(layout, levels, sent), received, read));
  EXPECT_EQ(received, sent);
  const Expected<LightState> key = read_key(layout, write_key(layout, sent));
  ASSERT_TRUE(key) << key.error().message();
  EXPECT_EQ(key->coefficients, sent.coefficients);
  // Once more, and there is no number for it
  LightState beyond = sent;
  const std::vector<std::byte> body = write_delta(layout, levels, beyond);
  const LightState before = received;
  const Expected<void> refused = read_delta(layout, body, received, read);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("out of range"));
  EXPECT_EQ(received, before);
}

TEST(LightCoding, RefusesBrokenBodiesAndKeepsItsState) {
  const LightLayout layout = test::made_layout(16);
  LightState sent = test::dark_state(layout);
  std::mt19937 random(2);
  for (int i = 0; i < 5; ++i) write_delta(layout, test::made_levels(layout, random), sent);
  const LightState before = sent;
  const std::vector<std::byte> delta = write_delta(layout, test::made_levels(layout, random), sent);
  const std::vector<std::byte> key = write_key(layout, sent);
  std::vector<std::int32_t> levels;
  for (std::size_t size = 0; size < delta.size(); size += 7) {
    LightState state = before;
    if (!read_delta(layout, std::span(delta).first(size), state, levels)) {
      EXPECT_EQ(state, before);
    }
  }
  int refused = 0;
  for (int run = 0; run < 400; ++run) {
    std::vector<std::byte> flipped = delta;
    flipped[random() % flipped.size()] ^= static_cast<std::byte>(1u << random() % 8);
    LightState state = before;
    if (!read_delta(layout, flipped, state, levels)) {
      EXPECT_EQ(state, before);
      ++refused;
    }
    std::vector<std::byte> flipped_key = key;
    flipped_key[random() % flipped_key.size()] ^= static_cast<std::byte>(1u << random() % 8);
    const Expected<LightState> read = read_key(layout, flipped_key);
    if (!read) {
      EXPECT_FALSE(read.error().cause.empty());
    }
  }
  // Most lead to another number of bytes, or to numbers of no size
  EXPECT_GT(refused, 300);
}

TEST(LightCoding, RefusesKeysOfSenselessUnits) {
  const LightLayout layout = test::made_layout(16);
  for (const float unit : {0.0f, -1.0f, 1e20f, std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity()}) {
    LightState state = test::dark_state(layout);
    state.unit = unit;
    const Expected<LightState> read = read_key(layout, write_key(layout, state));
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message(), HasSubstr("unit"));
  }
}

TEST(LightGeometry, ComesBackAsItWas) {
  std::mt19937 random(3);
  const FieldGeometry geometry = test::made_geometry(random);
  PartialGeometry read;
  const auto done = read_geometry(written(geometry), kPlenty, read);
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(read.here, std::vector<std::uint8_t>{1});
  EXPECT_EQ(read.geometry.corrections.size(), geometry.corrections.size());
  read.geometry.corrections = geometry.corrections;  // which come apart
  EXPECT_TRUE(same_geometry(read.geometry, geometry));
}

TEST(LightGeometry, ChangesAsItDidOnTheOtherSide) {
  std::mt19937 random(4);
  const FieldGeometry before = test::made_geometry(random);
  FieldGeometry now = before;
  now.volumes[0].grid.scroll = {0, 1, 1};
  now.volumes[0].grid.origin_ws.x += 0.5f;
  UpdatedProbes updated{{0, 1, 9, 30, 31}, {}};
  for (const int probe : updated.probes) {
    const std::span<const CodedMoments> tile = before.tile_of(probe);
    updated.tiles_before.insert(updated.tiles_before.end(), tile.begin(), tile.end());
    now.states[probe] = ProbeState::sleeping;
    now.offsets[probe] = encode_probe_offset({0.2f, -0.4f, 0.0f});
    for (std::size_t t = 0; t < now.tile(); t += 2) {
      now.moments[probe * now.tile() + t].mean = static_cast<std::uint8_t>(1 + random() % 127);
    }
  }
  for (const bool corrected : {false, true}) {
    if (corrected) now.corrections.pop_back();
    FieldGeometry client = before;
    const std::vector<std::byte> body = write_changes(updated, now, corrected);
    const Expected<GeometryChanges> read = read_changes(body, kPlenty, client);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->probes, updated.probes);
    EXPECT_EQ(read->corrections, corrected);
    EXPECT_EQ(client.corrections.size(), now.corrections.size());
    if (corrected) client.corrections = now.corrections;  // which come apart
    EXPECT_TRUE(same_geometry(client, now));
    EXPECT_LT(body.size(), written(now).size() / 2);
  }
}

TEST(LightGeometry, BringsCorrectionsInPiecesInAnyOrder) {
  std::mt19937 random(6);
  std::vector<CodedCorrectionBlock> blocks(2 * kPieceBlocks + 5);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    blocks[i].key =
        correction_key({static_cast<int>(i % 500), static_cast<int>(i / 500), 3}, 0, 0, 0);
    blocks[i].cells[i % 8] = {static_cast<std::uint8_t>(1 + random() % 63),
                              static_cast<std::uint8_t>(random() % 256), 3};
  }
  std::vector<CodedCorrectionBlock> read(blocks.size());
  for (const std::size_t piece : {2u, 0u, 1u, 0u}) {
    const auto body = write_corrections(piece, blocks);
    const auto done = read_corrections(body, 1, read);
    ASSERT_TRUE(done) << done.error().message();
    EXPECT_EQ(*done, piece);
    std::vector<CodedCorrectionBlock> copy = read;
    for (std::size_t size = 0; size + 5 < body.size(); size += body.size() / 9) {
      EXPECT_FALSE(read_corrections(std::span(body).first(size), 1, copy)) << size;
    }
    std::vector<std::byte> another = body;
    another[0] = std::byte{3};
    EXPECT_FALSE(read_corrections(another, 1, copy)) << "there are three";
    EXPECT_FALSE(read_corrections(body, 0, copy)) << "of a volume that is not there";
    EXPECT_TRUE(std::equal(copy.begin(), copy.end(), read.begin(),
                           [](const auto& a, const auto& b) {
                             return is_same_block(a.key, b.key) && a.cells == b.cells;
                           }))
        << "what is refused changes nothing";
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    ASSERT_TRUE(is_same_block(read[i].key, blocks[i].key) && read[i].cells == blocks[i].cells) << i;
  }
}

TEST(LightGeometry, RoundsMomentsToWhatLookupsBear) {
  constexpr float kLongest = 2.6f;
  EXPECT_EQ(encode_moments({0.0f, 0.0f}, kLongest), CodedMoments{});
  EXPECT_EQ(decode_moments({}, kLongest), glm::vec2(0.0f));
  for (float mean = 0.001f; mean < kLongest; mean *= 1.3f) {
    for (float deviation = 0.0f; deviation < 0.5f * kLongest; deviation += 0.07f) {
      const CodedMoments coded =
          encode_moments({mean, mean * mean + deviation * deviation}, kLongest);
      EXPECT_GT(coded.mean, 0);
      const glm::vec2 back = decode_moments(coded, kLongest);
      // Half a step of the mean, but for means that 0 would stand for
      EXPECT_NEAR(back.x, mean, std::max(0.51f * kLongest / 127, 1.001f * kLongest / 127 - mean));
      const float found = std::sqrt(std::max(back.y - back.x * back.x, 0.0f));
      EXPECT_NEAR(found, deviation, 0.02f * kLongest * std::sqrt(deviation) + 4e-3f);
    }
  }
}

TEST(LightGeometry, RoundsCorrectionsToWhatLookupsBear) {
  for (float samples = 0.02f; samples < 300.0f; samples *= 1.7f) {
    for (float ratio = 0.3f; ratio < 3.9f; ratio *= 1.1f) {
      for (const float seen : {0.01f, 0.2f, 1.0f, 3.0f}) {
        CorrectionBlock block = {correction_key({-3, 7, 1}, 4, 2, 1), {}};
        const float looked_up = seen * samples;
        block.cells[5] = {ratio * looked_up, looked_up, samples};
        const CorrectionBlock back = decode_corrections(encode_corrections({&block, 1})).front();
        EXPECT_TRUE(is_same_block(back.key, block.key));
        EXPECT_EQ(back.cells[4].samples, 0.0f);
        const CorrectionCell before = refined_correction(block.cells[5], 1.0f);
        const CorrectionCell after = refined_correction(back.cells[5], 1.0f);
        // Of a ratio about a hundredth; of how much it counts about a fifth
        EXPECT_NEAR(after.ratio / before.ratio, 1.0f,
                    0.01f + 0.08f * std::abs(before.ratio - 1.0f));
        EXPECT_NEAR(after.samples / before.samples, 1.0f, 0.1f);
      }
    }
  }
}

TEST(LightGeometry, CountsCorrectionsThatAreStillToComeAsMemory) {
  std::mt19937 random(7);
  FieldGeometry geometry = test::made_geometry(random);
  geometry.corrections.clear();
  const auto taken = [&](std::size_t most_bytes) {
    PartialGeometry read;
    return read_geometry(written(geometry), most_bytes, read).has_value();
  };
  std::size_t enough = 0;
  while (!taken(enough)) enough += 1000;
  FieldGeometry client = geometry;
  geometry.corrections.resize(32 * geometry.offsets.size());
  EXPECT_FALSE(taken(enough));
  EXPECT_TRUE(taken(kPlenty));
  const std::vector<std::byte> change = write_changes({}, geometry, true);
  EXPECT_FALSE(read_changes(change, enough, client));
  EXPECT_TRUE(client.corrections.empty());
  EXPECT_TRUE(read_changes(change, kPlenty, client));
}

TEST(LightGeometry, RefusesWhatNoFieldHas) {
  std::mt19937 random(5);
  const std::vector<std::byte> good = written(test::made_geometry(random));
  const auto with_word = [&](std::size_t offset, std::uint32_t word) {
    std::vector<std::byte> bytes = good;
    std::memcpy(&bytes[offset], &word, sizeof(word));
    PartialGeometry read;
    return read_geometry(bytes, kPlenty, read).has_value() && read.here.size() == 1;
  };
  EXPECT_TRUE(with_word(0, 2));
  EXPECT_FALSE(with_word(0, 3));              // texels of irradiance
  EXPECT_FALSE(with_word(4, 1000));           // texels of distance
  EXPECT_FALSE(with_word(8, 0));              // volumes
  EXPECT_FALSE(with_word(8, 64));             // more than there are bytes for
  EXPECT_FALSE(with_word(12, 1u << 30));      // more corrections than there is room for
  EXPECT_FALSE(with_word(24, 0));             // probes along x
  EXPECT_FALSE(with_word(24, 0xFFFFFFFFu));   // more than can be
  EXPECT_FALSE(with_word(24, 1u << 20));      // in all, more than can be
  EXPECT_FALSE(with_word(36, 0x7FC00000u));   // spacing that is no number
  EXPECT_FALSE(with_word(48, 0x40000000u));   // an axis of length 2
  EXPECT_FALSE(with_word(84, 0xFFFFu));       // a level that no cascade has
  EXPECT_FALSE(with_word(100, 4));            // scrolled by more than there are probes
  EXPECT_FALSE(with_word(112, 0x7F800000u));  // counts within an infinite box
  PartialGeometry none;
  const Expected<void> large = read_geometry(good, 1000, none);
  ASSERT_FALSE(large);
  EXPECT_THAT(large.error().message(), HasSubstr("memory"));
  for (std::size_t size = 0; size + 5 < good.size(); size += 11) {
    EXPECT_FALSE(read_geometry(std::span(good).first(size), kPlenty, none)) << size;
    EXPECT_TRUE(none.here.empty()) << size;
  }
}

TEST(LightFuzz, TakesItsCorpusAsItShould) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(LAMBENT_FUZZ_CORPUS) + "/light")) {
    const std::vector<std::byte> bytes = read_file(entry.path().string()).value();
    EXPECT_EQ(test::feed_light_decoder(bytes), "") << entry.path();
    ++files;
  }
  EXPECT_GE(files, 4);
}

}  // namespace
}  // namespace lambent::stream::light_coding_test
