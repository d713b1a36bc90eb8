// SPDX-License-Identifier: Apache-2.0
// Fields that engines record and that start from a field file, against the processor's from the
// same file.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "field/field_access.h"
#include "field/probes/probe_status.h"
#include "field/schedule/schedule.h"
#include "field/vulkan/device_arguments.h"
#include "field/vulkan/recorded_arguments.h"
#include "field/vulkan/recorded_plan.h"
#include "support/temporary_directory.h"
#include "twin/recorded_field.h"

namespace lambent::recorded_start_test {
namespace {

using test::cornell, test::recorded_settings;
using ::testing::HasSubstr;
using vulkan::BatchPlan, vulkan::ProbeBatch, vulkan::RecordedField, vulkan::RecordedFieldSettings;

constexpr int kBakedUpdates = 8;

// Both read the same words; sums in another order.
constexpr double kSameWords = 1e-6;
// The same rays and random numbers, in a solve that stops at the same residual.
constexpr double kSameRays = 0.002;
// What an update or a few add to an average of eight. From nothing, 72 rays a probe differ by 0.12.
constexpr double kStillThere = 0.03;

FieldSettings placed_settings() {
  FieldSettings settings = recorded_settings();
  settings.relocation = true;
  return settings;
}

FieldSettings cascades() {
  FieldSettings settings = recorded_settings();
  settings.cascades = 2;
  settings.probe_count = {4, 4, 4};
  settings.probe_spacing = 0.137f;  // [m]; not the lattice of the walls
  return settings;
}

class RecordedStart : public test::RecordedFieldTest {
 protected:
  void bake(const FieldSettings& settings, const UpdateRequest& request = {}) {
    IrradianceField field = IrradianceField::make(settings, cornell().bounds()).value();
    for (int i = 0; i < kBakedUpdates; ++i) field.update(cornell().world, request);
    ASSERT_TRUE(save_field(path, field, cornell().world));
  }
  IrradianceField loaded(const FieldSettings& settings) const {
    return std::move(load_field(path, settings, cornell().world).value().field);
  }
  RecordedField started(const FieldSettings& settings, const RecordedFieldSettings& recorded = {}) {
    RecordedField field = make(settings, recorded);
    const Expected<void> fine = field.start_from(path);
    EXPECT_TRUE(fine) << fine.error().message();
    return field;
  }
  /// Why a field of these settings does not start from the file; empty: it does.
  std::string refusal(const FieldSettings& settings) const {
    RecordedField field = make(settings, {});
    const Expected<void> fine = field.start_from(path);
    if (fine) return "";
    EXPECT_EQ(fine.error().file, path);
    EXPECT_EQ(field.updates(), 0u);
    const auto light = download<uint>(field.lookup_buffers().irradiance);
    EXPECT_TRUE(std::all_of(light.begin(), light.end(), [](uint word) { return word == 0; }));
    return fine.error().message();
  }

  test::TemporaryDirectory folder;
  std::string path = folder.file("baked.field");
  std::vector<FieldQuery> queries = test::seen_points(cornell());
};

TEST_F(RecordedStart, HasTheLightOfTheFileBeforeAnyUpdateAndAddsToItAfterwards) {
  const FieldSettings settings = placed_settings();
  bake(settings);
  IrradianceField on_cpu = loaded(settings);
  RecordedField field = started(settings);
  const std::vector<vec3> baked = test::look_up(on_cpu, queries);
  EXPECT_LE(difference(look_up(field, queries), baked), kSameWords);
  EXPECT_EQ(field.updates(), static_cast<std::uint32_t>(kBakedUpdates));
  // Probes stay where they stand, and average on with the rays that come next
  const auto places = download<uint>(field.lookup_buffers().offsets);
  EXPECT_GT(std::count_if(places.begin(), places.end(), [](uint word) { return word != 0; }), 20);
  update(field);
  on_cpu.update(cornell().world);
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), kSameRays);
  EXPECT_LE(difference(look_up(field, queries), baked), kStillThere);
  for (int i = 0; i < 3; ++i) update(field);
  EXPECT_EQ(download<uint>(field.lookup_buffers().offsets), places);
}

TEST_F(RecordedStart, ReadsTheCorrectionsOfTheFile) {
  FieldSettings settings = recorded_settings();
  settings.corrections = true;
  bake(settings);
  IrradianceField on_cpu = loaded(settings);
  RecordedField field = started(settings);
  const std::vector<vec3> baked = test::look_up(on_cpu, queries);
  std::vector<vec3> uncorrected(queries.size());
  look_up_irradiance(on_cpu, queries, CorrectionUse::none, uncorrected, cornell().world);
  EXPECT_GT(difference(uncorrected, baked), 0.02);
  EXPECT_LE(difference(look_up(field, queries), baked), kSameWords);
  // Surfels read them, too: no light is lost or added at the next bounces
  update(field);
  on_cpu.update(cornell().world);
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), kStillThere);
}

TEST_F(RecordedStart, LeavesProbesInSolidMatterOff) {
  const FieldSettings settings = recorded_settings();
  bake(settings);
  IrradianceField on_cpu = loaded(settings);
  RecordedField field = started(settings);
  const auto states = download<uint>(field.states());
  for (std::size_t probe = 0; probe < states.size(); ++probe) {
    EXPECT_EQ(states[probe] == kProbeOff, statuses_of(on_cpu)[probe].state == ProbeState::off);
  }
  EXPECT_GT(std::count(states.begin(), states.end(), kProbeOff), 0);
  update(field);
  on_cpu.update(cornell().world);
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), kSameRays);
}

TEST_F(RecordedStart, KeepsTheLightWhereProbesTakeTurnsOrTheDeviceDecides) {
  const FieldSettings settings = placed_settings();
  bake(settings);
  const std::vector<vec3> baked = test::look_up(loaded(settings), queries);
  RecordedFieldSettings turns, budget;
  turns.probes_per_update = 24;
  budget.rays_per_update = 24 * settings.rays_per_probe;
  for (const RecordedFieldSettings& recorded : {turns, budget}) {
    RecordedField field = started(settings, recorded);
    for (int i = 0; i < 4; ++i) update(field);
    EXPECT_LE(difference(look_up(field, queries), baked), kStillThere);
  }
  EXPECT_TRUE(started(settings, budget).plan().value().on_device);
}

TEST_F(RecordedStart, LetsTheDeviceRestWhatTheFileHasSettled) {
  FieldSettings settings = placed_settings();
  settings.hysteresis = 0.75f;  // averages of four updates, which the file has
  bake(settings);
  RecordedFieldSettings budget;
  budget.rays_per_update = 24 * settings.rays_per_probe;
  RecordedField field = started(settings, budget);
  ASSERT_TRUE(field.plan().value().on_device);
  device().run([&](vulkan::Recorder& to) { field.record_rays(to.commands()); });
  const auto launch = download<uint>(field.ray_launch());
  // The processor rarely traces those in open air: they are all that is left to do, in whole blocks
  const IrradianceField on_cpu = loaded(settings);
  const auto statuses = statuses_of(on_cpu);
  const float settled = 0.99f * longest_average(settings);
  const auto left = std::count_if(statuses.begin(), statuses.end(), [&](const ProbeStatus& status) {
    return status.state != ProbeState::off && status.samples < settled;
  });
  EXPECT_GT(left, 0);
  EXPECT_LE(left, kBlockProbes);
  EXPECT_EQ(launch[1], static_cast<uint>(kBlockProbes));
}

TEST_F(RecordedStart, AveragesNothingOfTheFileWhereHistoryIsNone) {
  FieldSettings settings = recorded_settings();
  settings.solve_tolerance = 1e-5f;
  bake(settings);
  RecordedField field = started(settings);
  update(field, {.history = 0.0f});
  RecordedField fresh = make(settings, {});
  for (int i = 0; i < kBakedUpdates; ++i) fresh.plan();  // as many random numbers later
  update(fresh, {.history = 0.0f});
  // The same rays; the solve starts from another light
  EXPECT_LE(difference(look_up(field, queries), look_up(fresh, queries)), 0.001);
}

TEST_F(RecordedStart, ScrollsCascadesFromWhereTheFileHasThem) {
  const FieldSettings settings = cascades();
  UpdateRequest request;
  request.viewer_ws = vec3(0.1f, 0.25f, 0.3f);
  bake(settings, request);
  IrradianceField on_cpu = loaded(settings);
  RecordedField field = started(settings);
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), kSameWords);
  // So far that the finer one scrolls at once, and keeps a part of its probes
  const vec3 there = *request.viewer_ws + vec3(0.34f, 0.0f, 0.0f);
  request.viewer_ws = there;
  const auto grids = [&] { return download<ProbeGrid>(field.lookup_buffers().grids); };
  const auto baked = grids();
  field.plan({.viewer_ws = there});
  device().run([&](vulkan::Recorder& to) { field.record_rays(to.commands()); });
  on_cpu.update(cornell().world, request);
  EXPECT_GT(grids().front().origin_ws.x, baked.front().origin_ws.x);
  for (int v = 0; v < 2; ++v) {
    EXPECT_EQ(grids()[v].origin_ws, on_cpu.grids()[v].origin) << "cascade " << v;
    EXPECT_EQ(grids()[v].scroll, store_of(on_cpu).grid(v).scroll) << "cascade " << v;
  }
}

TEST_F(RecordedStart, RefusesFilesOfOtherTilesAndVolumes) {
  const FieldSettings settings = recorded_settings();
  bake(settings);
  EXPECT_EQ(refusal(settings), "");
  const auto expect_refusal = [&](auto&& change, const char* cause) {
    FieldSettings other = settings;
    change(other);
    const std::string message = refusal(other);
    EXPECT_THAT(message, HasSubstr(path + ": "));
    EXPECT_THAT(message, HasSubstr(cause));
  };
  expect_refusal([](auto& s) { s.irradiance_format = IrradianceFormat::float32; },
                 "stores irradiance in another format");
  expect_refusal([](auto& s) { s.distance_format = DistanceFormat::rg32f; },
                 "stores distances in another format");
  expect_refusal([](auto& s) { s.irradiance_texels = 6; }, "irradiance tiles of 4 texels");
  expect_refusal([](auto& s) { s.distance_texels = 10; }, "distance tiles of 14 texels");
  expect_refusal([](auto& s) { s.probe_count = {5, 4, 5}; }, "has 5 x 4 x 4 probes, not 5 x 4 x 5");
  expect_refusal(
      [](auto& s) {
        s.cascades = 1;
        s.probe_count = {5, 4, 4};
      },
      "does not follow the viewer");
  expect_refusal(
      [](auto& s) {
        ProbeVolume& further = s.volumes.emplace_back();
        further.centre = vec3(0.25f);
        further.size = vec3(0.2f);
      },
      "has 1 volumes, not 2");
  const Bounds room = cornell().bounds();
  expect_refusal(
      [&](auto& s) {
        s.volume = {room.min, room.min + 0.9f * (room.max - room.min)};
      },
      "another spacing");
  const FieldGrid grid = loaded(settings).grids().front();
  const auto at = [&](float cells) {
    const vec3 low = grid.origin + vec3(cells * grid.spacing.x, 0.0f, 0.0f);
    return Bounds{low, low + grid.spacing * vec3(grid.count - 1)};
  };
  expect_refusal([&](auto& s) { s.volume = at(0.1f); }, "stands elsewhere");
  FieldSettings rounded = settings;
  rounded.volume = at(1e-5f);
  EXPECT_EQ(refusal(rounded), "");
}

TEST_F(RecordedStart, RefusesBrokenFilesAndFieldsThatHoldLight) {
  const FieldSettings settings = recorded_settings();
  EXPECT_NE(refusal(settings), "") << "there is no such file";
  bake(settings);
  RecordedField field = make(settings, {});
  update(field);
  const Expected<void> late = field.start_from(path);
  ASSERT_FALSE(late);
  EXPECT_THAT(late.error().message(), HasSubstr("holds light already"));
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, bytes - 100);
  EXPECT_THAT(refusal(settings), HasSubstr("is cut short"));
}

std::vector<ProbeStatus> averaged(std::size_t probes, float samples) {
  ProbeStatus status;
  status.samples = samples;
  return std::vector<ProbeStatus>(probes, status);
}

TEST(BatchPlan, GoesOnFromAFileWithThoseFirstThatAverageNothing) {
  RecordedFieldSettings recorded;
  recorded.probes_per_update = 30;
  BatchPlan plan(FieldSettings{}, recorded, std::vector<std::uint8_t>(100));
  std::vector<ProbeStatus> statuses = averaged(100, 9.0f);
  statuses[77].samples = 0.0f;
  statuses[88].samples = 0.0f;
  statuses[88].state = ProbeState::off;
  plan.start_from(500, statuses);
  const ProbeBatch first = plan.next({});
  EXPECT_EQ(first.update, 500u);
  EXPECT_EQ(first.probes.back(), 77);
  EXPECT_FALSE(first.discards_history);
  EXPECT_FALSE(first.places);
  EXPECT_FLOAT_EQ(plan.next({}).largest_blend_weight, 0.1f);
}

TEST(BatchPlan, FollowsEditsExactlyOnceAllProbesOfAFileHaveBeenTraced) {
  WorldChanges change;
  change.lights.resize(1);
  const vulkan::UpdatePlan edit = {.changes = {&change, 1}};
  const auto next_after = [&](int updates) {
    BatchPlan plan(FieldSettings{}, {}, std::vector<std::uint8_t>(100));
    plan.start_from(500, averaged(100, 9.0f));
    for (int i = 0; i < updates; ++i) plan.next({});
    return plan.next(edit);
  };
  EXPECT_FALSE(next_after(0).retraces);
  EXPECT_TRUE(next_after(0).discards_history);
  EXPECT_TRUE(next_after(1).retraces);
}

}  // namespace
}  // namespace lambent::recorded_start_test
