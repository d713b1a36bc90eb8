// SPDX-License-Identifier: Apache-2.0
// Fields that engines record, against the processor's on the same rays.
#include "twin/recorded_field.h"

#include <algorithm>
#include <limits>

#include "field/field_access.h"
#include "field/probes/probe_status.h"
#include "field/vulkan/recorded_arguments.h"
#include "field/vulkan/recorded_plan.h"

namespace lambent::recorded_field_test {
namespace {

using test::cornell, test::recorded_settings, test::RecordedFieldTest;
using vulkan::PlannedUpdate, vulkan::RecordedField, vulkan::RecordedFieldSettings;

TEST_F(RecordedFieldTest, HoldsWhatTheProcessorsFieldDoes) {
  const FieldSettings settings = recorded_settings();
  RecordedField field = make(settings, {});
  for (int i = 0; i < 3; ++i) update(field);
  const IrradianceField on_cpu = test::make_field(cornell(), settings, 3);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // The same rays and random numbers; sums in another order, and both stop at the same residual
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.005);

  // Probes in solid matter are off, and have no rays while they are not looked at
  const auto states = download<uint>(field.states());
  int off = 0;
  for (std::size_t probe = 0; probe < states.size(); ++probe) {
    EXPECT_EQ(states[probe] == kProbeOff, statuses_of(on_cpu)[probe].state == ProbeState::off);
    off += states[probe] == kProbeOff ? 1 : 0;
  }
  EXPECT_GT(off, 0);
  const auto rays = download<RayRecord>(field.rays());
  EXPECT_EQ(std::count_if(rays.begin(), rays.end(), [](const RayRecord& r) { return r.mask == 0; }),
            off * settings.rays_per_probe);
}

TEST_F(RecordedFieldTest, OfPartsOfItsProbesInTurnComesToTheSameLight) {
  const FieldSettings settings = recorded_settings();
  RecordedFieldSettings recorded;
  recorded.probes_per_update = 24;  // of 80: four updates a round, the last of eight probes
  RecordedField field = make(settings, recorded);
  for (int i = 0; i < 4 * 12; ++i) update(field);
  const IrradianceField on_cpu = test::make_field(cornell(), settings, 12);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // Noise of other rays: 12 x 72 a probe on both sides
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.08);
}

TEST_F(RecordedFieldTest, MovesProbesAtTheStartAndThenLeavesThem) {
  FieldSettings settings = recorded_settings();
  settings.relocation = true;
  RecordedFieldSettings recorded;
  recorded.placing_updates = 6;
  RecordedField field = make(settings, recorded);
  const auto offsets = [&] { return download<uint>(field.lookup_buffers().offsets); };
  for (int i = 0; i < 7; ++i) update(field);
  const std::vector<uint> placed = offsets();
  EXPECT_GT(std::count_if(placed.begin(), placed.end(), [](uint word) { return word != 0; }), 20);
  for (int i = 0; i < 2; ++i) update(field);
  EXPECT_EQ(offsets(), placed);
  const IrradianceField on_cpu = [&] {
    FieldSettings s = settings;
    s.seed = 5;
    return test::make_field(cornell(), s, 16);
  }();
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.1);
}

TEST_F(RecordedFieldTest, ForgetsWhatItIsToldTo) {
  FieldSettings settings = recorded_settings();
  settings.solve_tolerance = 1e-5f;
  RecordedField field = make(settings, {});
  for (int i = 0; i < 3; ++i) update(field);
  update(field, {.history = 0.0f});
  RecordedField fresh = make(settings, {});
  for (int i = 0; i < 3; ++i) fresh.plan();  // as many random numbers later
  update(fresh);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // The same rays; the solve starts from another light
  EXPECT_LE(difference(look_up(field, queries), look_up(fresh, queries)), 0.001);
}

TEST_F(RecordedFieldTest, TellsItsMemory) {
  FieldSettings settings = recorded_settings();
  const RecordedField field = make(settings, {});
  std::size_t known = 0;
  const vulkan::LookupBuffers buffers = field.lookup_buffers();
  for (const vulkan::BufferRange& range :
       {field.rays(), field.hits(), field.results(), field.states(), buffers.grids, buffers.offsets,
        buffers.irradiance, buffers.distance, buffers.record}) {
    known += range.bytes;
  }
  EXPECT_GT(field.bytes(), known);
  // What is in proportion to rays is most of it
  settings.rays_per_probe *= 2;
  const double ratio = static_cast<double>(make(settings, {}).bytes()) / field.bytes();
  EXPECT_GT(ratio, 1.5);
  EXPECT_LT(ratio, 2.0);
  settings.rays_per_probe /= 2;
  const std::size_t some = make(settings, {.probes_per_update = 8}).bytes();
  EXPECT_LT(some, field.bytes());
}

TEST_F(RecordedFieldTest, RefusesWhatItCannotDo) {
  const auto refused = [](const FieldSettings& settings, const RecordedFieldSettings& recorded) {
    return !RecordedField::make(shared_device(), settings, cornell().bounds(), recorded);
  };
  FieldSettings settings = recorded_settings();
  EXPECT_TRUE(refused(settings, {.frames_in_flight = 0}));
  EXPECT_TRUE(refused(settings, {.placing_updates = 1}));
  EXPECT_TRUE(refused(settings, {.probes_per_update = -1}));
  EXPECT_TRUE(refused(settings, {.rays_per_update = 7 * settings.rays_per_probe}));
  EXPECT_TRUE(refused(settings, {.probes_per_update = 8, .rays_per_update = 10000}));
  settings.max_bounces = 2;
  EXPECT_TRUE(refused(settings, {.rays_per_update = 10000}));
  EXPECT_TRUE(refused(settings, {.probes_per_update = 8}));
}

TEST_F(RecordedFieldTest, RefusesAPlanOutOfRangeAndBeginsNothing) {
  RecordedField field = make(recorded_settings(), {});
  for (const float history : {-0.1f, 1.1f, std::numeric_limits<float>::quiet_NaN()}) {
    const Expected<PlannedUpdate> planned = field.plan({.history = history});
    ASSERT_FALSE(planned) << history;
    EXPECT_EQ(planned.error().place, "history");
  }
  EXPECT_EQ(field.updates(), 0u);
}

TEST(BatchPlan, ServesEachProbeOnceARound) {
  RecordedFieldSettings recorded;
  recorded.probes_per_update = 30;
  recorded.placing_updates = 3;
  vulkan::BatchPlan plan(FieldSettings{}, recorded, std::vector<std::uint8_t>(100));
  for (int round = 0; round < 5; ++round) {
    int next = 0;
    for (int i = 0; i < 4; ++i) {
      const vulkan::ProbeBatch batch = plan.next({});
      for (const int probe : batch.probes) EXPECT_EQ(probe, next++);
      EXPECT_EQ(batch.places, round < 3);
      EXPECT_EQ(batch.discards_history, round < 2);
      EXPECT_FLOAT_EQ(batch.largest_blend_weight, round < 4 ? 1.0f : 0.5f);
    }
    EXPECT_EQ(next, 100);
  }
}

TEST(BatchPlan, LeavesItToTheDeviceOnceRoundsAreOver) {
  const FieldSettings settings;
  RecordedFieldSettings recorded;
  recorded.rays_per_update = 30 * settings.rays_per_probe;
  recorded.placing_updates = 3;
  vulkan::BatchPlan plan(settings, recorded, std::vector<std::uint8_t>(100));
  EXPECT_EQ(plan.most_probes(), 24);
  const auto expect_rounds = [&](int rounds) {
    for (int i = 0; i < rounds * 5; ++i) {
      const vulkan::ProbeBatch batch = plan.next({});
      EXPECT_FALSE(batch.on_device);
      EXPECT_EQ(batch.probes.front(), 24 * (i % 5));
      EXPECT_EQ(batch.count, i % 5 == 4 ? 4 : 24);
    }
  };
  const auto expect_device = [&] {
    const vulkan::ProbeBatch batch = plan.next({});
    EXPECT_TRUE(batch.on_device);
    EXPECT_EQ(batch.count, 24);
    EXPECT_FALSE(batch.places);
    EXPECT_FALSE(batch.discards_history);
  };
  expect_rounds(3);
  for (int i = 0; i < 20; ++i) expect_device();
  EXPECT_TRUE(plan.next({.place_again = true}).places);
  for (int i = 1; i < 3 * 5; ++i) EXPECT_FALSE(plan.next({}).on_device);
  expect_device();
}

}  // namespace
}  // namespace lambent::recorded_field_test
