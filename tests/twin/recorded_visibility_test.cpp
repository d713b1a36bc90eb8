// SPDX-License-Identifier: Apache-2.0
// Fields that engines record see probes by rays in the engine's structure, as our own worlds'
// fields on a device do in theirs.
#include <algorithm>

#include "shaders/engine_lookup_by_rays_rgen.h"
#include "shaders/occlusion_rmiss.h"
#include "twin/engine_structure.h"
#include "twin/recorded_field.h"
#include "vulkan/kernel.h"

namespace lambent::recorded_visibility_test {
namespace {

using test::Stage;
using vulkan::RecordedField, vulkan::RecordedFieldSettings;

// For the two rooms, whose wall is 5 cm thick; a cell is twenty times as wide. Tiles so coarse
// leave much to rays.
FieldSettings settings_of(Visibility visibility) {
  FieldSettings settings;
  settings.probe_spacing = 1.0f;
  settings.rays_per_probe = 64;
  settings.distance_texels = 4;
  settings.relocation = false;
  settings.corrections = false;
  settings.visibility = visibility;
  return settings;
}

/// Two rooms, an engine that renders them, and our own world of them on the device.
struct Rooms {
  Rooms(const char* name, const std::shared_ptr<vulkan::Device>& device)
      : stage(name), there(stage.scene, device), structure(*device, stage.scene) {}

  test::HostEngine engine() const { return {stage.world, stage.scene, structure.handle()}; }

  const Stage stage;
  const World there;
  test::EngineStructure structure;
};

class RecordedVisibility : public test::RecordedFieldTest {
 protected:
  static RecordedField make(const Rooms& rooms, const FieldSettings& settings,
                            const RecordedFieldSettings& recorded = {}) {
    return RecordedField::make(shared_device(), settings, rooms.stage.bounds(), recorded).value();
  }
  static RecordedField updated(const Rooms& rooms, const FieldSettings& settings, int updates,
                               const RecordedFieldSettings& recorded = {}) {
    RecordedField field = make(rooms, settings, recorded);
    for (int i = 0; i < updates; ++i) update(field, {}, rooms.engine());
    return field;
  }
  static IrradianceField our_own(const Rooms& rooms, const FieldSettings& settings, int updates) {
    IrradianceField field = IrradianceField::make(settings, rooms.stage.bounds()).value();
    for (int i = 0; i < updates; ++i) field.update(rooms.there);
    return field;
  }
  static std::vector<vec3> look_up_by_rays(const IrradianceField& field, const Rooms& rooms,
                                           std::span<const FieldQuery> queries) {
    std::vector<vec3> result(queries.size());
    field.irradiance(queries, result, &rooms.there);
    return result;
  }

  /// The engine's own lookup, which traces rays in its structure.
  static std::vector<vec3> look_up_by_rays(const RecordedField& field,
                                           const test::EngineStructure& structure,
                                           std::span<const FieldQuery> queries) {
    return look_up_record(download<FieldRecord>(field.lookup_buffers().record).front(), structure,
                          queries);
  }
  static std::vector<vec3> look_up_by_distances(const RecordedField& field,
                                                const test::EngineStructure& structure,
                                                std::span<const FieldQuery> queries) {
    auto record = download<FieldRecord>(field.lookup_buffers().record).front();
    record.visibility = kVisibilityMoments;
    return look_up_record(record, structure, queries);
  }
  static std::vector<vec3> look_up_record(const FieldRecord& record,
                                          const test::EngineStructure& structure,
                                          std::span<const FieldQuery> queries) {
    const test::Buffer asked = vulkan::upload(device(), queries, "queries");
    const test::Buffer found(device(), sizeof(vec3) * queries.size(), vulkan::Memory::device,
                             "found");
    const auto count = static_cast<std::uint32_t>(queries.size());
    const VkDeviceAddress address = structure.address();
    const EngineLookupByRaysArguments arguments = {
        {record, {asked.address()}, {found.address()}, count, 0u},
        uvec2(static_cast<uint>(address), static_cast<uint>(address >> 32))};
    const vulkan::RayKernel kernel(device(),
                                   {shaders::engine_lookup_by_rays_rgen(),
                                    shaders::occlusion_rmiss(),
                                    {},
                                    {},
                                    /*any_record=*/true},
                                   "engine");
    device().run([&](vulkan::Recorder& to) { to.trace(kernel, arguments, count); });
    return vulkan::download<vec3>(device(), found);
  }

  static float brightest(std::span<const vec3> light) {
    float most = 0.0f;
    for (const vec3& e : light) most = max(most, max(e.x, max(e.y, e.z)));
    return most;
  }
};

// Sums in another order; both solves stop at the same residual.
constexpr double kAlike = 0.005;

TEST_F(RecordedVisibility, HoldsAndFindsWhatOurOwnFieldOnTheDeviceDoes) {
  const Rooms rooms("two-rooms", shared_device());
  const std::vector<FieldQuery> queries = test::seen_points(rooms.stage);
  for (const Visibility visibility : {Visibility::hybrid, Visibility::exact}) {
    const RecordedField field = updated(rooms, settings_of(visibility), 3);
    const IrradianceField own = our_own(rooms, settings_of(visibility), 3);
    EXPECT_LE(difference(look_up_by_rays(field, rooms.structure, queries),
                         look_up_by_rays(own, rooms, queries)),
              kAlike);
    // By distances, to see what the probes hold
    EXPECT_LE(difference(look_up_by_distances(field, rooms.structure, queries),
                         test::look_up(own, queries)),
              kAlike);
  }
}

TEST_F(RecordedVisibility, IsWorthToAnEngineWhatItIsWorthToUs) {
  const Rooms rooms("two-rooms", shared_device());
  const std::vector<FieldQuery> queries = test::seen_points(rooms.stage);
  FieldSettings fine = settings_of(Visibility::exact);
  fine.probe_spacing = 0.35f;
  fine.rays_per_probe = 256;
  IrradianceField finer = IrradianceField::make(fine, rooms.stage.bounds()).value();
  for (int i = 0; i < 2; ++i) finer.update(rooms.stage.world);
  std::vector<vec3> truth(queries.size());
  finer.irradiance(queries, truth, &rooms.stage.world);

  double errors[2], errors_of_ours[2];
  for (const Visibility visibility : {Visibility::moments, Visibility::hybrid}) {
    const auto mode = static_cast<std::size_t>(visibility);
    const FieldSettings settings = settings_of(visibility);
    errors[mode] =
        difference(look_up_by_rays(updated(rooms, settings, 3), rooms.structure, queries), truth);
    errors_of_ours[mode] =
        difference(look_up_by_rays(our_own(rooms, settings, 3), rooms, queries), truth);
    EXPECT_NEAR(errors[mode], errors_of_ours[mode], 0.001);
  }
  // Most of the error is of cells a metre wide: 0.153 by distances, 0.143 of hybrid visibility
  EXPECT_LE(errors[1], errors[0] - 0.005);
}

TEST_F(RecordedVisibility, ASealedRoomIsDarkHoweverProbesTakeTurns) {
  const Rooms rooms("two-rooms-sealed", shared_device());
  const std::vector<FieldQuery> queries = test::seen_points(rooms.stage);
  const FieldSettings settings = settings_of(Visibility::hybrid);
  const int some = make(rooms, settings).probes() / 3;
  const RecordedFieldSettings at_once,
      in_turn = {.probes_per_update = some, .placing_updates = 0},
      by_device = {.rays_per_update = some * settings.rays_per_probe, .placing_updates = 0};
  const auto brightness = [&](Visibility visibility, const RecordedFieldSettings& recorded) {
    const RecordedField field = updated(rooms, settings_of(visibility), 12, recorded);
    return brightest(look_up_by_rays(field, rooms.structure, queries));
  };
  EXPECT_EQ(brightness(Visibility::hybrid, at_once), 0.0f);
  EXPECT_EQ(brightness(Visibility::hybrid, in_turn), 0.0f);
  // Probes that light came to while those on their own side of the wall had not been traced yet are
  // dark enough to rest; 0.009 is measured
  EXPECT_LE(brightness(Visibility::hybrid, by_device),
            0.02f * brightness(Visibility::moments, by_device));
}

TEST_F(RecordedVisibility, ASealedRoomIsDarkInCascadesThatScroll) {
  const Rooms rooms("two-rooms-sealed", shared_device());
  const std::vector<FieldQuery> queries = test::seen_points(rooms.stage);
  const auto brightness = [&](Visibility visibility) {
    FieldSettings settings = settings_of(visibility);
    settings.cascades = 2;
    settings.probe_count = {9, 7, 9};  // the finer one around the whole dark room
    settings.probe_spacing = 0.7f;
    settings.rays_per_probe = 32;
    RecordedField field = make(rooms, settings);
    for (const float x : {2.4f, 1.7f}) {
      update(field, {.viewer_ws = vec3(x, 1.4f, 0.0f)}, rooms.engine());
    }
    return brightest(look_up_by_rays(field, rooms.structure, queries));
  };
  EXPECT_GT(brightness(Visibility::moments), 0.0f);
  EXPECT_EQ(brightness(Visibility::hybrid), 0.0f);
}

TEST_F(RecordedVisibility, ADoorThatShutsLeavesDarkness) {
  const Stage stage("two-rooms-sealed");
  Scene scene = *scenes::make("two-rooms-sealed");
  const auto partition = std::find_if(
      scene.instances.begin(), scene.instances.end(),
      [&](const Instance& instance) { return scene.meshes[instance.mesh].name == "partition"; });
  ASSERT_NE(partition, scene.instances.end());
  const std::vector<FieldQuery> queries = test::seen_points(stage);
  constexpr float kAway = 100.0f;  // [m]
  struct Brightness {
    float before, after;
  };
  const auto brightness = [&](Visibility visibility) {
    partition->world_from_object[3].x += kAway;
    World world(scene);
    test::EngineStructure structure(device(), scene);
    RecordedField field =
        RecordedField::make(shared_device(), settings_of(visibility), stage.bounds(), {}).value();
    const auto found = [&] { return brightest(look_up_by_rays(field, structure, queries)); };
    for (int i = 0; i < 3; ++i) update(field, {}, {world, scene, structure.handle()});
    const float before = found();
    partition->world_from_object[3].x -= kAway;
    const WorldChanges changes = world.update().value();
    structure.place(scene);
    update(field, {.changes = std::span(&changes, 1)}, {world, scene, structure.handle()});
    return Brightness{before, found()};
  };
  const Brightness blind = brightness(Visibility::moments), hybrid = brightness(Visibility::hybrid);
  // What is left is of the averages' noise, which edits keep
  EXPECT_LE(hybrid.after, 0.01f * hybrid.before);
  EXPECT_GE(blind.after, 0.1f * blind.before);
}

TEST_F(RecordedVisibility, NeedsAStructure) {
  const Rooms rooms("two-rooms", shared_device());
  for (const Visibility visibility : {Visibility::hybrid, Visibility::exact}) {
    RecordedField field = make(rooms, settings_of(visibility));
    field.plan().value();
    device().run([&](vulkan::Recorder& to) {
      field.record_rays(to.commands());
      const Expected<void> recorded = field.record_update(to.commands());
      ASSERT_FALSE(recorded);
      EXPECT_EQ(recorded.error().place, "structure");
      EXPECT_TRUE(field.record_update(to.commands(), rooms.structure.handle()));
    });
  }
}

TEST_F(RecordedVisibility, CountsWhatItTakes) {
  const Rooms rooms("two-rooms", shared_device());
  const std::size_t blind = make(rooms, settings_of(Visibility::moments)).bytes();
  const std::size_t exact = make(rooms, settings_of(Visibility::exact)).bytes();
  const RecordedField hybrid = make(rooms, settings_of(Visibility::hybrid));
  // A million rays, with what they find; hybrid visibility also keeps a mark and a place a cell
  EXPECT_GE(exact - blind, (sizeof(RayRecord) + sizeof(uint)) << 20);
  EXPECT_EQ(hybrid.bytes() - exact, 2 * sizeof(uint) * hybrid.probes());
}

}  // namespace
}  // namespace lambent::recorded_visibility_test
