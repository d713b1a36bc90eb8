// SPDX-License-Identifier: Apache-2.0
#include "field/field_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/file_bytes.h"
#include "field/field_file_layout.h"
#include "support/field_scenes.h"
#include "support/temporary_directory.h"

namespace lambent {
namespace {

using test::make_field;
using test::Stage;
using ::testing::HasSubstr;

FieldSettings small_field() {
  FieldSettings settings;
  settings.probe_count = glm::ivec3(4, 3, 5);
  settings.rays_per_probe = 32;
  return settings;
}

std::vector<uint> words_of(const ProbeStore& store) {
  std::vector<uint> words(store.offset_words().begin(), store.offset_words().end());
  words.insert(words.end(), store.irradiance_words().begin(), store.irradiance_words().end());
  words.insert(words.end(), store.distance_words().begin(), store.distance_words().end());
  return words;
}

std::vector<FieldQuery> queries_in(const FieldGrid& grid) {
  std::vector<FieldQuery> queries;
  for (int i = 0; i < 50; ++i) {
    const vec3 share(fract(0.37f * i), fract(0.61f * i), fract(0.17f * i));
    const vec3 normal = normalize(share - 0.5f);
    queries.push_back({grid.origin + share * grid.spacing * vec3(grid.count - 1), normal, normal});
  }
  return queries;
}

/// A volume with every value that a file can hold, and no two probes alike.
FieldVolume made_volume(IrradianceFormat irradiance, DistanceFormat distance) {
  FieldVolume volume;
  volume.grid = still_grid({{-1.0f, 0.5f, 2.0f}, {0.5f, 1.0f, 0.25f}, {3, 2, 2}});
  volume.grid.axes = mat3(vec3(0, 0, -1), vec3(0, 1, 0), vec3(1, 0, 0));
  volume.grid.fade_centre = {1.25f, 0.5f, 0.75f};
  volume.grid.fade_half = {0.75f, 0.5f, 0.25f};
  volume.grid.fade_cells = {2.0f, 1.0f, 4.0f};
  volume.role = {true, 3};
  volume.irradiance_texels = 2;
  volume.distance_texels = 5;
  volume.irradiance_format = irradiance;
  volume.distance_format = distance;
  const int probes = probe_count(volume.grid);
  for (int i = 0; i < probes; ++i) {
    ProbeRecord record;
    record.samples = 1.5f * static_cast<float>(i);
    record.noise = 0.25f * static_cast<float>(i);
    record.noise_samples = static_cast<std::uint16_t>(1000 * i);
    record.state = static_cast<ProbeState>(i % 6);
    record.served = static_cast<std::uint32_t>(i);
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
      const ProbeRecord &x = a.records[p], &y = b.records[p];
      EXPECT_EQ(x.samples, y.samples);
      EXPECT_EQ(x.noise, y.noise);
      EXPECT_EQ(x.noise_samples, y.noise_samples);
      EXPECT_EQ(x.state, y.state);
      EXPECT_EQ(x.served, y.served);
    }
  }
}

TEST(FieldFile, StandsWhereTheDocumentSays) {
  const std::vector<std::byte> bytes = encode_field(made_file());
  const auto u32 = [&](std::size_t offset) {
    uint value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8u | std::to_integer<uint>(bytes[offset + i]);
    return value;
  };
  EXPECT_EQ(std::memcmp(bytes.data(), "LAMBENTF", 8), 0);
  EXPECT_EQ(u32(8), 2u);             // version
  EXPECT_EQ(u32(16), bytes.size());  // size
  EXPECT_EQ(u32(24), 1u);            // volumes
  EXPECT_EQ(u32(28), 11u);           // updates
  EXPECT_EQ(u32(64), bytes.size() - 64);
  EXPECT_EQ(u32(64 + 24), 0xBF800000u);   // origin.x = -1
  EXPECT_EQ(u32(64 + 48), 3u);            // count.x
  EXPECT_EQ(u32(64 + 72), 0xBF800000u);   // axes[0].z = -1
  EXPECT_EQ(u32(64 + 100), 0x3FA00000u);  // fade_centre.x = 1.25
  EXPECT_EQ(u32(64 + 112), 0x3F400000u);  // fade_half.x = 0.75
  EXPECT_EQ(u32(64 + 124), 0x40000000u);  // fade_cells.x = 2
  EXPECT_EQ(u32(64 + 136), 1u);           // follows the viewer
  EXPECT_EQ(u32(64 + 140), 3u);           // level
  const std::size_t records = 64 + 144, tiles = records + 24 * 12;
  EXPECT_EQ(u32(records + 24), encode_probe_offset({0.04f, -0.04f, 0.02f}));
  EXPECT_EQ(u32(records + 24 + 4), 1u);           // sleeping
  EXPECT_EQ(u32(records + 24 + 8), 0x3FC00000u);  // samples = 1.5
  EXPECT_EQ(u32(tiles), 0x3F000000u);             // the first texel
  EXPECT_EQ(bytes.size(), tiles + 4 * 12 * (4 * 4 + 7 * 7));
}

/// The reason why a file with these bytes is refused; empty: it is not.
std::string refusal(const std::vector<std::byte>& bytes) {
  const Expected<FieldFile> read = decode_field("a.field", bytes);
  return read ? "" : read.error().message();
}

void put_u32(std::vector<std::byte>& bytes, std::size_t offset, uint value) {
  for (int i = 0; i < 4; ++i) bytes[offset + i] = static_cast<std::byte>(value >> (8 * i));
}

/// The reason why a file is refused in which one word is another, but all else is right.
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
  EXPECT_THAT(refusal(longer), HasSubstr("has bytes after its last volume"));

  std::vector<std::byte> cut(whole.begin(), whole.end() - 8);
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
  EXPECT_THAT(refusal_with(8, 1), HasSubstr("is of version 1; version 2 can be read"));
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
  EXPECT_THAT(refusal_with(volume + 136, 2u), HasSubstr("role"));
  EXPECT_THAT(refusal_with(volume + 140, 17u), HasSubstr("role"));
  const std::size_t record = volume + kVolumeHeaderBytes + kRecordBytes;
  EXPECT_THAT(refusal_with(record, 1u << 31u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record, 512u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 4, 6), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 8, kInfinity), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 8, 0xBF800000u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 12, kNan), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 16, 0x10000u), HasSubstr("record of probe 1"));
  EXPECT_THAT(refusal_with(record + 20, 12), HasSubstr("record of probe 1"));
  FieldFile exact = made_file();
  exact.volumes[0] = made_volume(IrradianceFormat::float32, DistanceFormat::rg32f);
  const std::size_t tiles = volume + kVolumeHeaderBytes + 12 * kRecordBytes;
  EXPECT_EQ(refusal_with(tiles, 0x3F800000u, exact), "");
  EXPECT_THAT(refusal_with(tiles, kNan, exact), HasSubstr("not finite"));
  EXPECT_THAT(refusal_with(tiles + 4 * exact.volumes[0].irradiance.size(), kInfinity, exact),
              HasSubstr("not finite"));
}

class SavedField : public ::testing::Test {
 protected:
  testing::TemporaryDirectory folder;
  std::string path = folder.file("a.field");
  Stage stage{"cornell"};

  LoadedField load(const FieldSettings& settings = small_field()) const {
    Expected<LoadedField> loaded = load_field(path, settings, stage.world);
    if (!loaded) throw std::runtime_error(loaded.error().message());
    return std::move(*loaded);
  }
};

TEST_F(SavedField, IsTheSameToTheBit) {
  for (const bool exact : {false, true}) {
    FieldSettings settings = exact ? test::exact_formats() : FieldSettings{};
    settings.probe_count = small_field().probe_count;
    settings.rays_per_probe = 32;
    const IrradianceField field = make_field(stage, settings, 3);
    ASSERT_TRUE(save_field(path, field, stage.world));
    const LoadedField loaded = load();
    EXPECT_TRUE(loaded.same_light);
    EXPECT_EQ(words_of(loaded.field.store()), words_of(field.store()));
    EXPECT_EQ(loaded.field.grids()[0].origin, field.grids()[0].origin);
    EXPECT_EQ(loaded.field.grids()[0].spacing, field.grids()[0].spacing);
    EXPECT_EQ(loaded.field.updates(), 3);
    const std::vector<FieldQuery> queries = queries_in(field.grids()[0]);
    EXPECT_EQ(test::look_up(loaded.field, queries), test::look_up(field, queries));
    for (int p = 0; p < field.probes(); ++p) {
      EXPECT_EQ(loaded.field.records()[p].samples, field.records()[p].samples);
      EXPECT_EQ(loaded.field.records()[p].noise, field.records()[p].noise);
    }
  }
}

TEST_F(SavedField, GoesOnFromWhereItWas) {
  FieldSettings settings = test::exact_formats();
  settings.probe_count = small_field().probe_count;
  settings.rays_per_probe = 32;
  IrradianceField field = make_field(stage, settings, 6);
  ASSERT_TRUE(save_field(path, field, stage.world));
  LoadedField loaded = load(settings);
  // With nothing lost in the store's format, the next update of both is the same
  const UpdateStatistics a = field.update(stage.world), b = loaded.field.update(stage.world);
  EXPECT_EQ(a.change, b.change);
  EXPECT_EQ(words_of(loaded.field.store()), words_of(field.store()));
  EXPECT_EQ(loaded.field.updates(), 7);
  // Seven updates' mean moves less than a field's first
  EXPECT_LT(b.change, 0.2);
}

TEST_F(SavedField, StartsItsAverageAnewUnderOtherLight) {
  ASSERT_TRUE(save_field(path, make_field(stage, small_field(), 8), stage.world));
  Scene brighter = stage.scene;
  for (Light& light : brighter.lights) light.intensity *= 3.0f;
  for (Material& material : brighter.materials) material.emission *= 3.0f;
  const Stage other(std::move(brighter));
  Expected<LoadedField> loaded = load_field(path, small_field(), other.world);
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_FALSE(loaded->same_light);
  // The words are there ...
  const std::vector<FieldQuery> queries = queries_in(loaded->field.grids()[0]);
  const float before = test::look_up(loaded->field, queries)[7].g;
  EXPECT_GT(before, 0.0f);
  // ... and one update replaces them
  loaded->field.update(other.world);
  EXPECT_NEAR(test::look_up(loaded->field, queries)[7].g / before, 3.0f, 0.75f);
}

TEST_F(SavedField, FollowsEditsThatCameBeforeItsFirstUpdate) {
  Scene scene = stage.scene;
  World world(scene);
  ASSERT_TRUE(save_field(path, make_field(stage, small_field(), 8), stage.world));
  Expected<LoadedField> loaded = load_field(path, small_field(), world);
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_TRUE(loaded->same_light);
  const std::vector<FieldQuery> queries = queries_in(loaded->field.grids()[0]);
  const float before = test::look_up(loaded->field, queries)[7].g;
  for (Light& light : scene.lights) light.intensity *= 3.0f;
  for (Material& material : scene.materials) material.emission *= 3.0f;
  ASSERT_TRUE(world.update());
  loaded->field.update(world);
  EXPECT_NEAR(test::look_up(loaded->field, queries)[7].g / before, 3.0f, 0.75f);
}

TEST_F(SavedField, DoesNotPassOffLightFromBeforeAnEditAsTheWorldsOwn) {
  Scene scene = stage.scene;
  World world(scene);
  IrradianceField field = make_field(stage, small_field(), 8);
  for (Material& material : scene.materials) material.emission *= 3.0f;
  ASSERT_TRUE(world.update());
  ASSERT_TRUE(save_field(path, field, world));
  const FieldFile waiting = read_field_file(path).value();
  EXPECT_EQ(waiting.volumes[0].records[0].samples, 0.0f);
  field.update(world);
  ASSERT_TRUE(save_field(path, field, world));
  const FieldFile followed = read_field_file(path).value();
  EXPECT_GE(followed.volumes[0].records[0].samples, 1.0f);
}

TEST_F(SavedField, IsRefusedInAnotherScene) {
  ASSERT_TRUE(save_field(path, make_field(stage, small_field(), 1), stage.world));
  const Stage rooms("two-rooms");
  const Expected<LoadedField> other = load_field(path, small_field(), rooms.world);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message(), HasSubstr(path + ": is of another scene: one of "));

  Scene bent = stage.scene;
  bent.meshes[0].positions[0].x += 0.01f;
  const Stage bent_stage(std::move(bent));
  const Expected<LoadedField> shaped = load_field(path, small_field(), bent_stage.world);
  ASSERT_FALSE(shaped);
  EXPECT_THAT(shaped.error().message(), HasSubstr("one as large, but of another shape"));

  Scene moved = stage.scene;
  moved.instances[0].world_from_object[3].x += 0.01f;
  const Stage moved_stage(std::move(moved));
  EXPECT_FALSE(load_field(path, small_field(), moved_stage.world));
}

TEST_F(SavedField, MayHoldThingsThatMove) {
  Scene scene = stage.scene;
  scene.instances[0].dynamic = true;
  const Stage before(scene);
  ASSERT_TRUE(save_field(path, make_field(before, small_field(), 1), before.world));
  scene.instances[0].world_from_object[3].x += 0.1f;
  const Stage after(scene);
  const Expected<LoadedField> loaded = load_field(path, small_field(), after.world);
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_FALSE(loaded->same_light);
}

TEST_F(SavedField, LeavesNothingWhereItCannotBeWritten) {
  const IrradianceField field = make_field(stage, small_field(), 1);
  EXPECT_FALSE(save_field(folder.file("none/a.field"), field, stage.world));
  EXPECT_EQ(folder.entries(), 0u);
  EXPECT_FALSE(load_field(path, small_field(), stage.world));
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
}  // namespace lambent
