// SPDX-License-Identifier: Apache-2.0
// Cascades and further volumes of fields that engines record: they follow the viewer as those of
// the processor's fields do, and are looked up with the same blending.
#include <numeric>

#include "field/field_access.h"
#include "field/probes/volumes.h"
#include "field/vulkan/recorded_arguments.h"
#include "field/vulkan/recorded_plan.h"
#include "shared/random.h"
#include "twin/recorded_field.h"

namespace lambent::recorded_cascades_test {
namespace {

using test::cornell, test::recorded_settings;
using vulkan::BatchPlan, vulkan::ProbeBatch, vulkan::RecordedField, vulkan::RecordedFieldSettings;

constexpr float kSpacing = 0.137f;  // [m]

/// Two cascades in the box of half a metre. Their lattice is not that of the walls: whether a probe
/// in a wall sees it would be chance.
FieldSettings cascades() {
  FieldSettings settings = recorded_settings();
  settings.cascades = 2;
  settings.probe_count = {4, 4, 4};
  settings.probe_spacing = kSpacing;
  settings.rays_per_probe = 144;
  return settings;
}

vec3 viewer(int update) {
  return {0.12f + 0.08f * static_cast<float>(std::min(update, 4)), 0.25f, 0.3f};
}

/// Where the viewer comes to.
const vec3 kThere = viewer(1000);

/// Points around it, that ask in all directions.
std::vector<FieldQuery> near_viewer() {
  RandomStream random = make_random_stream(3, 1, 4);
  std::vector<FieldQuery> points(500);
  for (FieldQuery& point : points) {
    const vec3 u(next_uniform2(random), next_uniform(random));
    const vec3 v(next_uniform2(random), next_uniform(random));
    point.position_ws = kThere + 0.1f * (2.0f * u - 1.0f);
    point.normal_ws = point.to_viewer_ws = normalize(v - 0.5f);
  }
  return points;
}

/// What the processor's field holds there that has never been elsewhere. Its probes in open air are
/// hardly traced twice, so that each has as many rays as there may be.
std::vector<vec3> made_there() {
  FieldSettings settings = cascades();
  settings.rays_per_probe = 4096;
  IrradianceField field = IrradianceField::make(settings, cornell().bounds()).value();
  UpdateRequest request;
  request.viewer_ws = kThere;
  for (int i = 0; i < 2; ++i) field.update(cornell().world, request);
  return test::look_up(field, near_viewer());
}

// Noise of the processor's rays; 0.1 is measured.
constexpr double kNoise = 0.12;

class RecordedCascades : public test::RecordedFieldTest {
 protected:
  static std::vector<ProbeGrid> grids_of(const RecordedField& field) {
    return download<ProbeGrid>(field.lookup_buffers().grids);
  }
};

TEST_F(RecordedCascades, FollowTheViewerAsTheProcessorsDo) {
  constexpr int kUpdates = 32;
  RecordedField field = make(cascades(), {});
  IrradianceField on_cpu = IrradianceField::make(cascades(), cornell().bounds()).value();
  int recycled = 0;
  for (int i = 0; i < kUpdates; ++i) {
    update(field, {.viewer_ws = viewer(i)});
    UpdateRequest request;
    request.viewer_ws = viewer(i);
    recycled += on_cpu.update(cornell().world, request).probes_recycled;
    const std::vector<ProbeGrid> grids = grids_of(field);
    for (int volume = 0; volume < 2; ++volume) {
      const ProbeGrid& expected = store_of(on_cpu).grid(volume);
      EXPECT_EQ(grids[volume].origin_ws, expected.origin_ws);
      EXPECT_EQ(grids[volume].scroll, expected.scroll);
      EXPECT_EQ(grids[volume].fade_centre, expected.fade_centre);
      EXPECT_EQ(grids[volume].fade_half, expected.fade_half);
    }
  }
  EXPECT_GE(recycled, 32);
  EXPECT_LE(difference(look_up(field, near_viewer()), made_there()), kNoise);
}

TEST_F(RecordedCascades, KnowNothingOfTheirOldPlaces) {
  // The same light as if the field had been made where the viewer has come to
  FieldSettings settings = cascades();
  settings.cascades = 1;  // which is traced in every update
  settings.solve_tolerance = 1e-5f;
  RecordedField field = make(settings, {}), fresh = make(settings, {});
  const vec3 here(0.2f, 0.2f, 0.2f);
  // A multiple of its probes away, so that probes have the same random numbers
  const vec3 far_away = here + vec3(100.0f * 4.0f * kSpacing, 0.0f, 0.0f);
  update(field, {.viewer_ws = far_away});
  update(field, {.viewer_ws = far_away});
  fresh.plan({.viewer_ws = here});
  fresh.plan({.viewer_ws = here});  // as many random numbers later
  update(field, {.viewer_ws = here});
  update(fresh, {.viewer_ws = here});
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  // Rounding of positions changes which of their candidates a few surfels choose
  EXPECT_LE(difference(look_up(field, queries), look_up(fresh, queries)), 0.002);
}

TEST_F(RecordedCascades, HaveNoWeightBeforeTheyAreTraced) {
  const FieldSettings settings = cascades();
  RecordedField field = make(settings, {});
  update(field, {.viewer_ws = vec3(0.2f)});
  field.plan({.viewer_ws = vec3(30.0f, 0.2f, 0.2f)});  // all probes have new places
  device().run([&](vulkan::Recorder& to) { field.record_rays(to.commands()); });
  for (const uint word : download<uint>(field.lookup_buffers().distance)) ASSERT_EQ(word, 0u);
  for (const vec3& found : look_up(field, test::seen_points(cornell()))) {
    ASSERT_EQ(found, vec3(0.0f));
  }
}

TEST_F(RecordedCascades, AreFollowedByADeviceThatChoosesItsProbes) {
  FieldSettings settings = cascades();
  RecordedFieldSettings recorded;
  recorded.rays_per_update = 64 * settings.rays_per_probe;  // of 128 probes
  RecordedField field = make(settings, recorded);
  for (int i = 0; i < 48; ++i) update(field, {.viewer_ws = viewer(i / 3)});
  EXPECT_LE(difference(look_up(field, near_viewer()), made_there()), kNoise);
}

TEST_F(RecordedCascades, LookFurtherVolumesUpFirst) {
  FieldSettings settings = recorded_settings();
  ProbeVolume further;
  further.centre = vec3(0.25f);
  further.size = vec3(0.3f);
  further.probe_count = {4, 4, 4};
  settings.volumes = {further};
  RecordedField field = make(settings, {});
  for (int i = 0; i < 3; ++i) update(field);
  const IrradianceField on_cpu = test::make_field(cornell(), settings, 3);
  const std::vector<FieldQuery> queries = test::seen_points(cornell());
  EXPECT_LE(difference(look_up(field, queries), test::look_up(on_cpu, queries)), 0.005);
}

/// Fifty probes of level 0, then as many of level 2.
std::vector<std::uint8_t> two_levels() {
  std::vector<std::uint8_t> levels(100, 0);
  std::fill(levels.begin() + 50, levels.end(), std::uint8_t{2});
  return levels;
}

TEST(BatchPlan, ServesCoarseCascadesLessOften) {
  RecordedFieldSettings recorded;
  recorded.placing_updates = 3;
  BatchPlan plan(FieldSettings{}, recorded, two_levels());
  std::vector<int> served(100, 0);
  for (int round = 0; round < 3 + 8; ++round) {
    const ProbeBatch batch = plan.next({});
    for (const int probe : batch.probes) ++served[probe];
  }
  // All take part in placement
  for (int probe = 0; probe < 100; ++probe) EXPECT_EQ(served[probe], 3 + (probe < 50 ? 8 : 2));
}

TEST(BatchPlan, ServesRecycledProbesFirst) {
  RecordedFieldSettings recorded;
  recorded.probes_per_update = 10;
  recorded.placing_updates = 0;
  BatchPlan plan(FieldSettings{}, recorded, two_levels());
  for (int i = 0; i < 40; ++i) plan.next({});
  std::vector<int> recycled(25);
  std::iota(recycled.begin(), recycled.end(), 70);
  std::vector<int> first = plan.next({}, recycled).probes;
  for (int i = 0; i < 2; ++i) {
    for (const int probe : plan.next({}).probes) first.push_back(probe);
  }
  ASSERT_GE(first.size(), 25u);  // a batch ends with its round
  EXPECT_EQ(std::vector<int>(first.begin(), first.begin() + 20),
            std::vector<int>(recycled.begin(), recycled.begin() + 20));
  // The last five, before others whose turn it is
  for (int probe = 90; probe < 95; ++probe) {
    EXPECT_EQ(std::count(first.begin(), first.end(), probe), 1) << probe;
  }
}

TEST(BatchPlan, ExpectsNoHistoryOfRecycledProbes) {
  BatchPlan plan(FieldSettings{}, {.placing_updates = 0}, two_levels());
  for (int i = 0; i < 8; ++i) plan.next({});
  EXPECT_LT(plan.next({}).largest_blend_weight, 0.5f);
  const std::vector<int> recycled = {60};
  EXPECT_FLOAT_EQ(plan.next({}, recycled).largest_blend_weight, 1.0f);
}

}  // namespace
}  // namespace lambent::recorded_cascades_test
