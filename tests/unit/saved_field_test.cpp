// SPDX-License-Identifier: Apache-2.0
// Fields that go to a file and come back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "core/files/file_bytes.h"
#include "field/field_access.h"
#include "field/file/field_file.h"
#include "support/field_scenes.h"
#include "support/temporary_directory.h"

namespace lambent::saved_field_test {
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

class SavedField : public ::testing::Test {
 protected:
  test::TemporaryDirectory folder;
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
    EXPECT_EQ(words_of(store_of(loaded.field)), words_of(store_of(field)));
    EXPECT_EQ(loaded.field.grids()[0].origin, field.grids()[0].origin);
    EXPECT_EQ(loaded.field.grids()[0].spacing, field.grids()[0].spacing);
    EXPECT_EQ(loaded.field.updates(), 3);
    const std::vector<FieldQuery> queries = queries_in(field.grids()[0]);
    EXPECT_EQ(test::look_up(loaded.field, queries), test::look_up(field, queries));
    for (int p = 0; p < field.probes(); ++p) {
      EXPECT_EQ(statuses_of(loaded.field)[p].samples, statuses_of(field)[p].samples);
      EXPECT_EQ(statuses_of(loaded.field)[p].variance, statuses_of(field)[p].variance);
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
  EXPECT_EQ(words_of(store_of(loaded.field)), words_of(store_of(field)));
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

}  // namespace
}  // namespace lambent::saved_field_test
