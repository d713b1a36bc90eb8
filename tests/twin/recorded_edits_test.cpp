// SPDX-License-Identifier: Apache-2.0
// Fields that engines record follow what they are told of edits: after one update they hold the
// light that a field made for the place as it is now holds.
#include <set>

#include "field/vulkan/recorded_arguments.h"
#include "field/vulkan/recorded_plan.h"
#include "twin/recorded_field.h"

namespace lambent::recorded_edits_test {
namespace {

using test::cornell, test::recorded_settings;
using vulkan::BatchPlan, vulkan::ProbeBatch, vulkan::RecordedField, vulkan::RecordedFieldSettings,
    vulkan::UpdatePlan;

/// A scene that is edited, and a field over it that an engine records.
class Edited {
 public:
  explicit Edited(const char* name = "cornell") : scene(*scenes::make(name)), world(scene) {}

  /// Tells what differs since the last call.
  const WorldChanges& edit() {
    changes = world.update().value();
    return changes;
  }
  UpdatePlan plan() const { return {.changes = std::span(&changes, 1)}; }

  Scene scene;
  World world;
  WorldChanges changes;
};

class RecordedEdits : public test::RecordedFieldTest {
 protected:
  static constexpr int kUpdates = 6;

  RecordedField settled(const Edited& edited, const FieldSettings& settings) {
    RecordedField field = make(settings, {});
    for (int i = 0; i < kUpdates; ++i) update(field, {}, edited.world);
    return field;
  }
  static std::vector<vec3> light_of(const RecordedField& field) {
    return look_up(field, test::seen_points(cornell()));
  }
  static std::vector<uint> words_of(const vulkan::BufferRange& range) {
    return download<uint>(range);
  }
};

// Noise of 72 rays a probe, and of their history ratios; 0.08 is measured.
constexpr double kNoise = 0.1;

/// Settings whose noise is small beside what is tested.
FieldSettings settings_of_edits() {
  FieldSettings settings = recorded_settings();
  settings.solve_tolerance = 1e-4f;
  return settings;
}

TEST_F(RecordedEdits, LightThatGetsBrighterArrivesInOneUpdate) {
  Edited edited;
  RecordedField field = settled(edited, settings_of_edits());
  std::vector<vec3> expected = light_of(field);
  for (vec3& light : expected) light *= 3.0f;
  for (Material& material : edited.scene.materials) material.emission *= 3.0f;
  edited.edit();
  ASSERT_TRUE(edited.changes.emission);
  update(field, edited.plan(), edited.world);
  // Of all that was averaged nothing is lost
  EXPECT_LE(difference(light_of(field), expected), 0.01);
}

TEST_F(RecordedEdits, LightThatGoesOutLeavesDarkness) {
  Edited edited;
  RecordedField field = settled(edited, settings_of_edits());
  for (Material& material : edited.scene.materials) material.emission = vec3(0.0f);
  edited.edit();
  update(field, edited.plan(), edited.world);
  for (const vec3& light : light_of(field)) EXPECT_LE(max(light.x, max(light.y, light.z)), 1e-5f);
}

TEST_F(RecordedEdits, LightThatComesOnInDarknessArrivesInOneUpdate) {
  Edited edited;
  const std::vector<Material> lit = edited.scene.materials;
  for (Material& material : edited.scene.materials) material.emission = vec3(0.0f);
  edited.edit();
  RecordedField field = settled(edited, settings_of_edits());
  edited.scene.materials = lit;
  edited.edit();
  update(field, edited.plan(), edited.world);
  // The same rays as those of a field of which this is the first update
  RecordedField fresh = make(settings_of_edits(), {});
  for (int i = 0; i + 1 < kUpdates; ++i) fresh.plan();
  update(fresh, {}, edited.world);
  // The distances of the one average six updates, those of the other none
  EXPECT_LE(difference(light_of(field), light_of(fresh)), 0.02);
}

TEST_F(RecordedEdits, AnObjectThatMovesIsFollowed) {
  Edited edited;
  const FieldSettings settings = settings_of_edits();
  RecordedField field = settled(edited, settings);
  RecordedField untold = settled(edited, settings);
  edited.scene.instances.back().world_from_object[3].x += 100.0f;
  edited.edit();
  ASSERT_FALSE(edited.changes.moved.empty());
  update(field, edited.plan(), edited.world);
  update(untold, {}, edited.world);
  // What a field built anew comes to, after as many updates as make noise small
  FieldSettings other = settings;
  other.seed = 77;
  RecordedField fresh = make(other, {});
  for (int i = 0; i < 24; ++i) update(fresh, {}, edited.world);
  const std::vector<vec3> expected = light_of(fresh);
  EXPECT_LE(difference(light_of(field), expected), kNoise);
  EXPECT_GE(difference(light_of(untold), expected), 1.5 * kNoise);
}

TEST_F(RecordedEdits, FollowsLightThatBecomesMuchBrighterAsTheProcessorDoes) {
  Edited edited;
  const FieldSettings settings = settings_of_edits();
  for (Material& material : edited.scene.materials) material.emission *= 0.01f;
  edited.edit();
  RecordedField field = settled(edited, settings);
  IrradianceField on_cpu = IrradianceField::make(settings, cornell().bounds()).value();
  for (int i = 0; i < kUpdates; ++i) on_cpu.update(edited.world);
  std::vector<vec3> scaled = light_of(field);
  for (vec3& light : scaled) light *= 100.0f;
  for (Material& material : edited.scene.materials) material.emission *= 100.0f;
  edited.edit();
  update(field, edited.plan(), edited.world);
  on_cpu.update(edited.world);
  EXPECT_LE(difference(light_of(field), test::look_up(on_cpu, test::seen_points(cornell()))), 0.01);
  // Most of the history is given up, for the light may be of another lamp
  EXPECT_GT(difference(light_of(field), scaled), 0.02);
}

TEST_F(RecordedEdits, FollowsWhatTheProcessorsFieldFollows) {
  Edited edited;
  const FieldSettings settings = settings_of_edits();
  RecordedField field = settled(edited, settings);
  IrradianceField on_cpu = IrradianceField::make(settings, cornell().bounds()).value();
  for (int i = 0; i < kUpdates; ++i) on_cpu.update(edited.world);
  edited.scene.instances.back().world_from_object[3].x += 0.1f;
  for (Material& material : edited.scene.materials) material.emission *= 0.5f;
  edited.edit();
  update(field, edited.plan(), edited.world);
  on_cpu.update(edited.world);
  EXPECT_LE(difference(light_of(field), test::look_up(on_cpu, test::seen_points(cornell()))), 0.01);
}

TEST_F(RecordedEdits, ProbesThatAnEditDoesNotReachKeepTheirBits) {
  Edited edited;
  RecordedField field = settled(edited, settings_of_edits());
  const std::vector<uint> before = words_of(field.lookup_buffers().irradiance);
  const std::vector<uint> distances = words_of(field.lookup_buffers().distance);
  // An edit that changes nothing that a ray meets
  edited.changes = {};
  edited.changes.moved = {{vec3(90.0f), vec3(91.0f)}};
  update(field, edited.plan(), edited.world);
  const std::vector<uint> after = words_of(field.lookup_buffers().irradiance);
  const auto states = download<uint>(field.states());
  const std::size_t tile = before.size() / states.size();
  std::set<std::size_t> changed;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (after[i] != before[i] && states[i / tile] == kProbeOn) changed.insert(i / tile);
  }
  // The history ratios of a few dark texels are beyond what is corrected
  EXPECT_LE(changed.size(), states.size() / 10);
  EXPECT_EQ(words_of(field.lookup_buffers().distance), distances);
}

TEST_F(RecordedEdits, ChangesTooSmallToSeeAddUp) {
  Edited edited;
  RecordedField field = settled(edited, settings_of_edits());
  std::vector<vec3> expected = light_of(field);
  constexpr int kSteps = 12;
  constexpr float kStep = 1.004f;
  for (int i = 0; i < kSteps; ++i) {
    for (Material& material : edited.scene.materials) material.emission *= kStep;
    for (vec3& light : expected) light *= kStep;
    edited.edit();
    update(field, edited.plan(), edited.world);
  }
  EXPECT_LE(difference(light_of(field), expected), 0.01);
}

TEST_F(RecordedEdits, AreFollowedInCascades) {
  FieldSettings settings = settings_of_edits();
  settings.cascades = 3;
  settings.probe_count = {4, 4, 4};
  settings.probe_spacing = 0.137f;
  const vec3 here(0.27f), there(0.36f);
  const auto with_viewer = [](UpdatePlan plan, const vec3& viewer_ws) {
    plan.viewer_ws = viewer_ws;
    return plan;
  };
  Edited edited("cornell-spot");  // whose light is no matter of chance
  const auto scale_lights = [&](float factor) {
    for (Light& light : edited.scene.lights) light.intensity *= factor;
    edited.edit();
  };
  RecordedField field = make(settings, {});
  for (int i = 0; i < 9; ++i) update(field, {.viewer_ws = here}, edited.world);
  std::vector<vec3> expected = light_of(field);
  for (vec3& light : expected) light *= 3.0f;
  // Probes of coarse cascades have traced other rays last, and all are traced again
  scale_lights(3.0f);
  update(field, with_viewer(edited.plan(), here), edited.world);
  EXPECT_LE(difference(light_of(field), expected), 0.05);
  scale_lights(0.0f);
  update(field, with_viewer(edited.plan(), there), edited.world);
  for (const vec3& light : light_of(field)) EXPECT_LE(max(light.x, max(light.y, light.z)), 1e-5f);
}

TEST_F(RecordedEdits, BeginAnewWhereProbesTakeTurns) {
  Edited edited;
  const FieldSettings settings = settings_of_edits();
  for (const RecordedFieldSettings& recorded :
       {RecordedFieldSettings{.probes_per_update = 40},
        RecordedFieldSettings{.rays_per_update = 40 * settings.rays_per_probe}}) {
    RecordedField field = make(settings, recorded);
    for (int i = 0; i < 16; ++i) update(field, {}, edited.world);
    for (Material& material : edited.scene.materials) material.emission *= 0.25f;
    edited.edit();
    update(field, edited.plan(), edited.world);
    for (int i = 0; i < 7; ++i) update(field, {}, edited.world);
    RecordedField fresh = make(settings, recorded);
    for (int i = 0; i < 16; ++i) update(fresh, {}, edited.world);
    EXPECT_LE(difference(light_of(field), light_of(fresh)), 0.15);
  }
}

WorldChanges rebuilt() {
  WorldChanges changes;
  changes.rebuilt = changes.moved = {{vec3(0.0f), vec3(1.0f)}};
  return changes;
}

TEST(BatchPlan, RetracesTheLastRaysOfAllProbesAfterAnEdit) {
  BatchPlan plan(FieldSettings{}, {}, std::vector<std::uint8_t>(100));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(plan.next({}).retraces);
  const WorldChanges changes = rebuilt();
  for (int i = 0; i < 2; ++i) {
    const ProbeBatch batch = plan.next({.changes = std::span(&changes, 1)});
    EXPECT_TRUE(batch.retraces);
    EXPECT_EQ(batch.count, 100);
    EXPECT_EQ(batch.drawn_in, std::vector<std::uint32_t>{9});
  }
  const ProbeBatch next = plan.next({});
  EXPECT_FALSE(next.retraces);
  EXPECT_EQ(next.drawn_in, std::vector<std::uint32_t>{12});
  // Told that nothing differs
  const WorldChanges nothing;
  EXPECT_FALSE(plan.next({.changes = std::span(&nothing, 1)}).retraces);
}

TEST(BatchPlan, PlacesProbesAgainOnceWhatWasRebuiltKeepsStill) {
  BatchPlan plan(FieldSettings{}, {}, std::vector<std::uint8_t>(100));
  for (int i = 0; i < 20; ++i) plan.next({});
  const WorldChanges changes = rebuilt();
  for (int i = 0; i < 12; ++i) {
    EXPECT_FALSE(plan.next({.changes = std::span(&changes, 1)}).place_again);
  }
  int after = 1;
  while (!plan.next({}).place_again) ASSERT_LT(++after, 20);
  EXPECT_EQ(after, 8);
  EXPECT_TRUE(plan.next({}).places);
  EXPECT_FALSE(plan.next({}).place_again);
}

TEST(BatchPlan, DiscardsHistoryAfterAnEditWhereProbesTakeTurns) {
  RecordedFieldSettings recorded;
  recorded.probes_per_update = 50;
  BatchPlan plan(FieldSettings{}, recorded, std::vector<std::uint8_t>(100));
  for (int i = 0; i < 40; ++i) plan.next({});
  const WorldChanges changes = rebuilt();
  for (int i = 0; i < 4; ++i) {
    const ProbeBatch batch =
        i == 0 ? plan.next({.changes = std::span(&changes, 1)}) : plan.next({});
    EXPECT_TRUE(batch.discards_history);
    EXPECT_FLOAT_EQ(batch.largest_blend_weight, 1.0f);
    EXPECT_EQ(batch.probes.front(), 50 * (i % 2));
  }
  EXPECT_FALSE(plan.next({}).discards_history);
}

}  // namespace
}  // namespace lambent::recorded_edits_test
