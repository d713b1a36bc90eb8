// SPDX-License-Identifier: Apache-2.0
#include "field/file/field_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/files/file_bytes.h"
#include "field/file/layout.h"

namespace lambent::field_file_test {
namespace {

using ::testing::HasSubstr;

/// A volume with a value for everything that a file stores, and no two probes alike.
FieldVolume made_volume(IrradianceFormat irradiance, DistanceFormat distance) {
  FieldVolume volume;
  volume.grid = still_grid({{-1.0f, 0.5f, 2.0f}, {0.5f, 1.0f, 0.25f}, {3, 2, 2}});
  volume.grid.axes = mat3(vec3(0, 0, -1), vec3(0, 1, 0), vec3(1, 0, 0));
  volume.grid.fade_centre = {1.25f, 0.5f, 0.75f};
  volume.grid.fade_half = {0.75f, 0.5f, 0.25f};
  volume.grid.fade_cells = {2.0f, 1.0f, 4.0f};
  volume.role = {false, 3};
  volume.irradiance_texels = 2;
  volume.distance_texels = 5;
  volume.irradiance_format = irradiance;
  volume.distance_format = distance;
  const int probes = probe_count(volume.grid);
  for (int i = 0; i < probes; ++i) {
    ProbeStatus record;
    record.samples = 1.5f * static_cast<float>(i);
    record.variance = 0.25f * static_cast<float>(i);
    record.variance_samples = static_cast<std::uint16_t>(1000 * i);
    record.state = static_cast<ProbeState>(i % 6);
    record.last_traced = static_cast<std::uint32_t>(i);
    volume.records.push_back(record);
    volume.offsets.push_back(encode_probe_offset(vec3(0.04f, -0.04f, 0.02f) * float(i)));
  }
  volume.irradiance.resize(tile_words(probes, 2, words_per_texel(irradiance)));
  volume.distance.resize(tile_words(probes, 5, words_per_texel(distance)));
  uint next = 0x3F000000u;  // 0.5, where words are floats
  for (uint& word : volume.irradiance) word = next++;
  for (uint& word : volume.distance) word = next++;
  return volume;
}

FieldFile made_file() {
  FieldFile file;
  file.updates = 11;
  file.scene = {1, 2, 3, 4, 5};
  file.volumes.push_back(made_volume(IrradianceFormat::rgb9e5, DistanceFormat::rg16f));
  CorrectionBlock block = {correction_key({1, 2, -1}, 2, 1, 0), {}};
  block.cells[0] = {0.5f, 1.0f, 1.5f};
  file.corrections.push_back(block);
  return file;
}

TEST(FieldFile, KeepsEveryNumberOfEveryFormatAndVolume) {
  FieldFile file = made_file();
  file.volumes.push_back(made_volume(IrradianceFormat::r11g11b10f, DistanceFormat::rg32f));
  file.volumes.push_back(made_volume(IrradianceFormat::float32, DistanceFormat::rg16f));
  const Expected<FieldFile> read = decode_field("f", encode_field(file));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->updates, file.updates);
  EXPECT_EQ(read->scene, file.scene);
  ASSERT_EQ(read->volumes.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const FieldVolume &a = file.volumes[i], &b = read->volumes[i];
    EXPECT_EQ(a.grid.origin_ws, b.grid.origin_ws);
    EXPECT_EQ(a.grid.axes, b.grid.axes);
    EXPECT_EQ(a.grid.fade_centre, b.grid.fade_centre);
    EXPECT_EQ(a.grid.fade_half, b.grid.fade_half);
    EXPECT_EQ(a.grid.fade_cells, b.grid.fade_cells);
    EXPECT_EQ(a.role.follows_viewer, b.role.follows_viewer);
    EXPECT_EQ(a.role.level, b.role.level);
    EXPECT_EQ(a.grid.spacing, b.grid.spacing);
    EXPECT_EQ(a.grid.count, b.grid.count);
    EXPECT_EQ(a.irradiance_texels, b.irradiance_texels);
    EXPECT_EQ(a.distance_texels, b.distance_texels);
    EXPECT_EQ(a.irradiance_format, b.irradiance_format);
    EXPECT_EQ(a.distance_format, b.distance_format);
    EXPECT_EQ(a.offsets, b.offsets);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.distance, b.distance);
    for (std::size_t p = 0; p < a.records.size(); ++p) {
      const ProbeStatus &x = a.records[p], &y = b.records[p];
      EXPECT_EQ(x.samples, y.samples);
      EXPECT_EQ(x.variance, y.variance);
      EXPECT_EQ(x.variance_samples, y.variance_samples);
      EXPECT_EQ(x.state, y.state);
      EXPECT_EQ(x.last_traced, y.last_traced);
    }
  }
}

TEST(FieldFile, KeepsCorrections) {
  const FieldFile file = made_file();
  const Expected<FieldFile> read = decode_field("", encode_field(file));
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->corrections.size(), 1u);
  EXPECT_TRUE(is_same_block(read->corrections[0].key, file.corrections[0].key));
  EXPECT_EQ(read->corrections[0].cells[0].gathered, 0.5f);
  EXPECT_EQ(read->corrections[0].cells[0].looked_up, 1.0f);
  EXPECT_EQ(read->corrections[0].cells[0].samples, 1.5f);
  EXPECT_EQ(read->corrections[0].cells[7].samples, 0.0f);
}

TEST(FieldFile, StandsWhereTheDocumentSays) {
  const std::vector<std::byte> bytes = encode_field(made_file());
  const auto u32 = [&](std::size_t offset) {
    uint value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8u | std::to_integer<uint>(bytes[offset + i]);
    return value;
  };
  EXPECT_EQ(std::memcmp(bytes.data(), "LAMBENTF", 8), 0);
  EXPECT_EQ(u32(8), 3u);             // version
  EXPECT_EQ(u32(16), bytes.size());  // size
  EXPECT_EQ(u32(24), 1u);            // volumes
  EXPECT_EQ(u32(28), 11u);           // updates
  EXPECT_EQ(u32(64), bytes.size() - 64 - 4 - 104);
  EXPECT_EQ(u32(64 + 24), 0xBF800000u);   // origin.x = -1
  EXPECT_EQ(u32(64 + 48), 3u);            // count.x
  EXPECT_EQ(u32(64 + 72), 0xBF800000u);   // axes[0].z = -1
  EXPECT_EQ(u32(64 + 100), 0x3FA00000u);  // fade_centre.x = 1.25
  EXPECT_EQ(u32(64 + 112), 0x3F400000u);  // fade_half.x = 0.75
  EXPECT_EQ(u32(64 + 124), 0x40000000u);  // fade_cells.x = 2
  EXPECT_EQ(u32(64 + 136), 0u);           // follows the viewer
  EXPECT_EQ(u32(64 + 140), 3u);           // level
  const std::size_t records = 64 + 144, tiles = records + 24 * 12;
  EXPECT_EQ(u32(records + 24), encode_probe_offset({0.04f, -0.04f, 0.02f}));
  EXPECT_EQ(u32(records + 24 + 4), 1u);           // sleeping
  EXPECT_EQ(u32(records + 24 + 8), 0x3FC00000u);  // samples = 1.5
  EXPECT_EQ(u32(tiles), 0x3F000000u);             // the first texel
  const std::size_t corrections = tiles + 4 * 12 * (4 * 4 + 7 * 7);
  EXPECT_EQ(u32(corrections), 1u);                // blocks
  EXPECT_EQ(u32(corrections + 4), 0x00020001u);   // x = 1, y = 2
  EXPECT_EQ(u32(corrections + 8), 0x800AFFFFu);   // z = -1, facing along z, of the second level
  EXPECT_EQ(u32(corrections + 12), 0x3F000000u);  // gathered = 0.5
  EXPECT_EQ(u32(corrections + 20), 0x3FC00000u);  // samples = 1.5
  EXPECT_EQ(bytes.size(), corrections + 4 + 104);
}

/// The error with which a file of these bytes is rejected; empty: it is accepted.
std::string refusal(const std::vector<std::byte>& bytes) {
  const Expected<FieldFile> read = decode_field("a.field", bytes);
  return read ? "" : read.error().message();
}

void put_u32(std::vector<std::byte>& bytes, std::size_t offset, uint value) {
  for (int i = 0; i < 4; ++i) bytes[offset + i] = static_cast<std::byte>(value >> (8 * i));
}

/// The error with which a file is rejected in which only one word is wrong.
std::string refusal_with(std::size_t offset, uint value, const FieldFile& file = made_file()) {
  std::vector<std::byte> bytes = encode_field(file);
  put_u32(bytes, offset, value);
  seal_field(bytes);
  return refusal(bytes);
}

TEST(FieldFile, RefusesWhatIsNoFieldOrNotAllOfOne) {
  const std::vector<std::byte> whole = encode_field(made_file());
  EXPECT_EQ(refusal(whole), "");
  EXPECT_THAT(refusal({}), HasSubstr("a.field: is not a field file"));
  EXPECT_THAT(refusal(std::vector<std::byte>(500)), HasSubstr("is not a field file"));
  for (std::size_t size = 8; size < whole.size(); ++size) {
    EXPECT_THAT(refusal({whole.begin(), whole.begin() + size}), HasSubstr("is cut short"));
  }
  std::vector<std::byte> longer = whole;
  longer.push_back({});
  EXPECT_THAT(refusal(longer), HasSubstr("is longer"));
  seal_field(longer);
  EXPECT_THAT(refusal(longer), HasSubstr("corrections: have a size that does not fit"));

  std::vector<std::byte> cut(whole.begin(), whole.end() - 8);
  seal_field(cut);
  EXPECT_THAT(refusal(cut), HasSubstr("corrections: have a size that does not fit"));
  cut.resize(cut.size() - 104);
  seal_field(cut);
  EXPECT_THAT(refusal(cut), HasSubstr("volume 0: has a size that does not fit its probes"));
}

TEST(FieldFile, RefusesAnyBitThatFlipped) {
  const std::vector<std::byte> whole = encode_field(made_file());
  for (std::size_t i = kSizeOffset + sizeof(std::uint64_t); i < whole.size(); i += 7) {
    std::vector<std::byte> flipped = whole;
    flipped[i] ^= std::byte{4};
    EXPECT_THAT(refusal(flipped), HasSubstr("checksum"));
  }
}

TEST(FieldFile, RefusesOtherVersions) {
  EXPECT_THAT(refusal_with(8, 1), HasSubstr("is of version 1; version 3 can be read"));
  EXPECT_THAT(refusal_with(8, 0), HasSubstr("is of version 0"));
}

TEST(FieldFile, RefusesNumbersThatNoFieldHas) {
  constexpr uint kNan = 0x7FC00000u, kInfinity = 0x7F800000u;
  EXPECT_THAT(refusal_with(24, 0), HasSubstr("has 0 volumes"));
  EXPECT_THAT(refusal_with(24, 1000000), HasSubstr("has 1000000 volumes"));
  EXPECT_THAT(refusal_with(24, 2), HasSubstr("volume 1: is cut short"));
  EXPECT_THAT(refusal_with(60, 128), HasSubstr("header"));
  const std::size_t volume = kHeaderBytes;
  EXPECT_THAT(refusal_with(volume, 7), HasSubstr("size that does not fit"));
  EXPECT_THAT(refusal_with(volume + 8, 3), HasSubstr("unknown format"));
  EXPECT_THAT(refusal_with(volume + 12, 2), HasSubstr("unknown format"));
  EXPECT_THAT(refusal_with(volume + 16, 3), HasSubstr("irradiance tiles"));
  EXPECT_THAT(refusal_with(volume + 16, 0xFFFFFFFEu), HasSubstr("irradiance tiles"));
  EXPECT_THAT(refusal_with(volume + 20, 0xFFFFFFFFu), HasSubstr("distance tiles"));
  EXPECT_THAT(refusal_with(volume + 24, kNan), HasSubstr("makes no sense"));
  for (const uint spacing : {0u, 0xBF800000u, kNan, kInfinity, 1u}) {
    EXPECT_THAT(refusal_with(volume + 36, spacing), HasSubstr("makes no sense"));
  }
  EXPECT_THAT(refusal_with(volume + 48, 1), HasSubstr("senseless number of probes"));
  EXPECT_THAT(refusal_with(volume + 48, 0x80000000u), HasSubstr("senseless number of probes"));
  EXPECT_THAT(refusal_with(volume + 48, 1u << 19u), HasSubstr("more probes"));
  EXPECT_THAT(refusal_with(volume + 48, 1u << 17u), HasSubstr("does not fit its probes"));
  EXPECT_THAT(refusal_with(volume + 60, 0x3F800000u), HasSubstr("unit"));
  EXPECT_THAT(refusal_with(volume + 64, 0x3F800000u), HasSubstr("no rotation"));
  EXPECT_THAT(refusal_with(volume + 64, kNan), HasSubstr("no rotation"));
  EXPECT_THAT(refusal_with(volume + 100, kInfinity), HasSubstr("counts within a box"));
  EXPECT_THAT(refusal_with(volume + 112, 0u), HasSubstr("counts within a box"));
  EXPECT_THAT(refusal_with(volume + 124, 0u), HasSubstr("counts within a box"));
  EXPECT_THAT(refusal_with(volume + 136, 1u), HasSubstr("cannot follow"));
  EXPECT_THAT(refusal_with(28, 0xFFFFFFFFu), HasSubstr("updates"));
  EXPECT_THAT(refusal_with(volume + 136, 2u), HasSubstr("role"));
  EXPECT_THAT(refusal_with(volume + 140, 17u), HasSubstr("role"));
  const std::size_t record = volume + kVolumeHeaderBytes + kRecordBytes;
  EXPECT_THAT(refusal_with(record, 1u << 31u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record, 512u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 4, 6), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 8, kInfinity), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 8, 0xBF800000u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 12, kNan), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 12, kInfinity), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 16, 0x10000u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 20, 12), HasSubstr("record of probe 1"));
  const std::size_t key = encode_field(made_file()).size() - kCorrectionBlockBytes;
  for (const uint rest : {0u, 0x000AFFFFu, 0x800EFFFFu, 0x801AFFFFu, 0x802AFFFFu}) {
    EXPECT_THAT(refusal_with(key + 4, rest), HasSubstr("corrections: name a senseless block"));
  }
  for (const uint sum : {kNan, kInfinity, 0xBF800000u}) {
    EXPECT_THAT(refusal_with(key + 8, sum), HasSubstr("corrections: hold sums"));
  }
  FieldFile exact = made_file();
  exact.volumes[0] = made_volume(IrradianceFormat::float32, DistanceFormat::rg32f);
  const std::size_t tiles = volume + kVolumeHeaderBytes + 12 * kRecordBytes;
  EXPECT_EQ(refusal_with(tiles, 0x3F800000u, exact), "");
  EXPECT_THAT(refusal_with(tiles, kNan, exact), HasSubstr("not within -1e18 to 1e18"));
  EXPECT_THAT(refusal_with(tiles + 4 * exact.volumes[0].irradiance.size(), kInfinity, exact),
              HasSubstr("not within -1e18 to 1e18"));
}

TEST(FieldCorpus, HoldsFilesThatAreReadAndFilesThatAreRefused) {
  int read = 0, refused = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(LAMBENT_FUZZ_CORPUS) + "/field")) {
    std::vector<std::byte> bytes = read_file(entry.path().string()).value();
    seal_field(bytes);
    ++(refusal(bytes).empty() ? read : refused);
  }
  EXPECT_GE(read, 3);
  EXPECT_GE(refused, 2);
}

}  // namespace
}  // namespace lambent::field_file_test
