// SPDX-License-Identifier: Apache-2.0
// How the field follows edits of the world.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "field/edits/history_ratio_math.h"
#include "field/field_access.h"
#include "field/field_state.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "field/schedule/schedule.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "support/edited_field.h"
#include "support/hand_made.h"

namespace lambent::field_edit_test {
namespace {

using test::Edited;
using test::light_of;
using test::mean;
using test::relative_rmse;
using test::words_of;

TEST(FieldEdit, LightThatGetsBrighterArrivesInOneUpdateWithoutAProbeRay) {
  Edited edited("cube");
  const std::vector<double> before = light_of(edited.field);
  edited.scene.lights[0].intensity *= 3.0f;
  const UpdateStatistics statistics = edited.follow();
  EXPECT_EQ(statistics.probe_rays, 0u);
  EXPECT_GT(statistics.shadow_rays, 0u);
  EXPECT_EQ(statistics.probes_changed, 125);
  std::vector<double> expected = before;
  for (double& e : expected) e *= 3.0;
  // The error is that of the solve, not the noise of the rays
  EXPECT_LT(relative_rmse(light_of(edited.field), expected), 0.005);
}

TEST(FieldEdit, SingleBrightRaysDoNotFlash) {
  // A lamp just above the floor lights a spot that few rays hit, each of which brings far more than
  // all others. This was 5.5 while the history ratio was at least a half
  FieldSettings settings = Edited::few();
  settings.corrections = false;
  Scene scene = scenes::make("cornell-spot").value();
  const Bounds room = open_bounds(World(scene));
  scene.lights[0].type = Light::Type::point;
  scene.lights[0].position_ws = glm::mix(room.min, room.max, glm::vec3(0.3f, 0.01f, 0.4f));
  Edited edited(std::move(scene), settings, 24);
  const std::vector<double> before = light_of(edited.field);
  edited.scene.lights[0].intensity *= 1.1f;
  edited.follow();
  const std::vector<double> after = light_of(edited.field);
  const double least = 0.01 * mean(before);
  double brightest = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    brightest = std::max(brightest, after[i] / std::max(before[i], least));
  }
  EXPECT_LT(brightest, 1.25);
}

TEST(FieldEdit, HistoryRatiosCanBeDividedBy) {
  const vec4 ratio = history_ratio_between(vec4(1.0f), vec4(0.0f, 0.5f, 9.0f, 0.0f));
  EXPECT_GT(ratio.x, 0.0f);
  EXPECT_EQ(ratio.y, 0.5f);
  EXPECT_EQ(ratio.z, kMaxHistoryRatio);
  EXPECT_EQ(history_ratio_between(vec4(0.0f), vec4(1.0f)).x, 1.0f);
}

TEST(FieldEdit, LightThatGoesOutLeavesDarkness) {
  Edited edited("cube");
  ASSERT_GT(mean(light_of(edited.field)), 0.0);
  edited.scene.lights.clear();
  edited.follow();
  for (const double light : light_of(edited.field)) EXPECT_EQ(light, 0.0);
}

TEST(FieldEdit, LightThatComesOnInDarknessArrivesInOneUpdate) {
  Edited edited("cube", Edited::few(), 0);
  const std::vector<Light> lights = edited.scene.lights;
  edited.scene.lights.clear();
  ASSERT_TRUE(edited.world.update().has_value());
  edited.field.update(edited.world);
  ASSERT_EQ(mean(light_of(edited.field)), 0.0);
  edited.scene.lights = lights;
  edited.follow();
  const std::vector<double> settled = light_of(edited.settled());
  EXPECT_NEAR(mean(light_of(edited.field)), mean(settled), 0.03 * mean(settled));
}

TEST(FieldEdit, EmissionThatChangesIsFollowed) {
  Edited edited("cornell");
  const std::vector<double> before = light_of(edited.field);
  for (Material& material : edited.scene.materials) material.emission *= 0.25f;
  EXPECT_LT(edited.follow().probe_rays, 125u * 16u);  // those that hit the lamp
  std::vector<double> expected = before;
  for (double& e : expected) e *= 0.25;
  EXPECT_LT(relative_rmse(light_of(edited.field), expected), 0.01);
}

TEST(FieldEdit, ObjectThatMovesIsFollowedWithTheRaysItMeets) {
  Edited edited("cornell");
  const double old_error = relative_rmse(light_of(edited.field), light_of(Edited("cornell").field));
  EXPECT_EQ(old_error, 0.0);
  Instance& block = edited.scene.instances.back();
  block.world_from_object[3] += glm::vec4(0.5f, 0.0f, 0.4f, 0.0f);
  const std::vector<double> before = light_of(edited.field);
  const UpdateStatistics statistics = edited.follow();
  EXPECT_GT(statistics.probe_rays, 0u);
  EXPECT_LT(statistics.probe_rays, 125u * 128u / 2u);
  const std::vector<double> settled = light_of(edited.settled());
  EXPECT_LT(relative_rmse(light_of(edited.field), settled), 0.5 * relative_rmse(before, settled));
  EXPECT_NEAR(mean(light_of(edited.field)), mean(settled), 0.05 * mean(settled));
}

TEST(FieldEdit, SkyThatChangesIsFollowedWithoutARay) {
  Edited edited("furnace-sky");
  const std::vector<double> before = light_of(edited.field);
  ASSERT_GT(mean(before), 0.0);
  edited.scene.environment.radiance *= 2.0f;
  const UpdateStatistics statistics = edited.follow();
  EXPECT_EQ(statistics.probe_rays + statistics.shadow_rays, 0u);
  std::vector<double> expected = before;
  for (double& e : expected) e *= 2.0;
  EXPECT_LT(relative_rmse(light_of(edited.field), expected), 0.01);
}

TEST(FieldEdit, ProbesThatItCannotReachKeepTheirBits) {
  FieldSettings settings = Edited::few();
  settings.probe_count = {8, 4, 4};
  Edited edited("two-rooms-sealed", settings);
  // A second lamp, which is the only one that lights the other room
  Light lamp = edited.scene.lights[0];
  const Bounds bounds = open_bounds(edited.world);
  lamp.position_ws = bounds.min + bounds.max - lamp.position_ws;
  lamp.position_ws.y = edited.scene.lights[0].position_ws.y;
  edited.scene.lights.push_back(lamp);
  edited.follow();
  edited.follow();
  const std::vector<uint> before = words_of(edited.field);

  edited.scene.lights[1].intensity *= 2.0f;
  const UpdateStatistics statistics = edited.follow();
  const std::vector<uint> after = words_of(edited.field);
  EXPECT_GT(statistics.probes_changed, 128 / 4);
  EXPECT_LT(statistics.probes_changed, 128 * 3 / 4);
  const std::size_t words = before.size() / 128;
  int changed = 0;
  for (int probe = 0; probe < 128; ++probe) {
    changed += std::equal(before.begin() + probe * words, before.begin() + (probe + 1) * words,
                          after.begin() + probe * words)
                   ? 0
                   : 1;
  }
  EXPECT_LE(changed, statistics.probes_changed);
}

TEST(FieldEdit, AnEditOfNothingIsNoEdit) {
  Edited edited("cube");
  const UpdateStatistics statistics = edited.follow();
  EXPECT_EQ(statistics.probes_invalidated, 0);
  // The 27 probes in open air, which light no surface, are sleeping, and a few have their turns
  EXPECT_NEAR(statistics.probes_traced, 98 + 27.0 / kSleepingPeriod, 1.0);
}

TEST(FieldEdit, OpenAirFollowsEditsThatNeverEnd) {
  Edited edited("cube");
  const FieldGrid& grid = edited.field.grids()[0];
  const FieldQuery middle{grid.origin + 0.5f * grid.spacing * glm::vec3(grid.count - 1)};
  const auto light_in_the_middle = [&] {
    glm::vec3 e;
    edited.field.irradiance({&middle, 1}, {&e, 1});
    return luminance(e);
  };
  const float before = light_in_the_middle();
  edited.scene.lights[0].intensity *= 3.0f;
  for (int i = 0; i < 12; ++i) {
    // Every update has an edit, which is too small to be visible
    edited.scene.lights[0].intensity *= 1.0001f;
    ASSERT_TRUE(edited.world.update().has_value());
    edited.field.update(edited.world, {.ray_budget = 1u << 20});
  }
  EXPECT_NEAR(light_in_the_middle() / before, 3.0f, 0.15f);
}

TEST(FieldEdit, ChangesTooSmallToSeeAddUp) {
  Edited edited("cube");
  std::vector<double> expected = light_of(edited.field);
  constexpr int kEdits = 40;
  constexpr float kStep = 1.003f;
  for (int i = 0; i < kEdits; ++i) {
    edited.scene.lights[0].intensity *= kStep;
    edited.follow();
  }
  const double brighter = std::pow(kStep, kEdits);
  for (double& e : expected) e *= brighter;
  EXPECT_LT(relative_rmse(light_of(edited.field), expected), 0.01);
}

TEST(FieldEdit, GoesOnWithAnotherWorldOfTheSameScene) {
  Edited edited("cube");
  edited.scene.lights[0].intensity *= 3.0f;
  edited.follow();
  ASSERT_GT(edited.world.revision(), 0u);
  // Revisions count from 0 again: averages of later revisions must be discarded
  const World another(edited.scene);
  edited.field.update(another);
  EXPECT_LT(relative_rmse(light_of(edited.field), light_of(edited.settled())), 0.1);
}

TEST(FieldEdit, WhatDoesNotReceiveStaysDarkForTheNextBounce) {
  // The first bounce remains: surfaces still reflect direct light
  Scene scene = scenes::make("cube").value();
  const auto mean_light = [&] {
    const World world(scene);
    IrradianceField field = IrradianceField::make(Edited::few(), open_bounds(world)).value();
    for (int i = 0; i < 4; ++i) field.update(world);
    return mean(light_of(field));
  };
  const double all_bounces = mean_light();
  for (Instance& instance : scene.instances) instance.receives_gi = false;
  const double first_bounce = mean_light();
  EXPECT_GT(first_bounce, 0.1 * all_bounces);
  EXPECT_LT(first_bounce, 0.9 * all_bounces);
  FieldSettings one_bounce = Edited::few();
  one_bounce.max_bounces = 1;
  for (Instance& instance : scene.instances) instance.receives_gi = true;
  const Edited limited("cube", one_bounce, 4);
  EXPECT_NEAR(first_bounce, mean(light_of(limited.field)), 0.002 * all_bounces);
}

std::vector<uint> offsets_of(const IrradianceField& field) {
  const auto words = store_of(field).offset_words();
  return {words.begin(), words.end()};
}

TEST(FieldEdit, ProbesMakeWayForWhatIsBuiltAmongThemOnceItKeepsStill) {
  Edited edited("cornell");
  const std::vector<uint> before = offsets_of(edited.field);
  // The tall block moves in every frame, though it is not marked as dynamic
  Instance& block = edited.scene.instances.back();
  ASSERT_FALSE(block.dynamic);
  const Bounds bounds = open_bounds(edited.world);
  for (int i = 0; i < 12; ++i) {
    block.world_from_object[3].x += 0.01f * (bounds.max.x - bounds.min.x);
    ASSERT_TRUE(edited.world.update());
    edited.field.update(edited.world);
    EXPECT_EQ(offsets_of(edited.field), before) << i;
  }
  for (int i = 0; i < 16; ++i) edited.field.update(edited.world);
  EXPECT_NE(offsets_of(edited.field), before);
  // Probes stand where those of a new field for the current scene do, and hold the same light
  const IrradianceField fresh = edited.settled();
  std::vector<double> held, expected;
  for (int probe = 0; probe < fresh.probes(); ++probe) {
    EXPECT_EQ(store_of(edited.field).offset_words()[probe], store_of(fresh).offset_words()[probe]);
    EXPECT_EQ(statuses_of(edited.field)[probe].state, statuses_of(fresh)[probe].state);
    if (statuses_of(fresh)[probe].state == ProbeState::off) continue;
    for (int t = 1; t <= 4; ++t) {
      held.push_back(luminance(store_of(edited.field).irradiance_texel(probe, {t, t})));
      expected.push_back(luminance(store_of(fresh).irradiance_texel(probe, {t, t})));
    }
  }
  EXPECT_LT(relative_rmse(held, expected), 0.06);
}

TEST(FieldEdit, ABudgetIsKeptAndTheLightArrivesAfterAFewUpdates) {
  Edited edited("cube");
  std::vector<double> expected = light_of(edited.field);
  for (double& e : expected) e *= 3.0;
  edited.scene.lights[0].intensity *= 3.0f;
  ASSERT_TRUE(edited.world.update().has_value());
  constexpr std::uint64_t kBudget = 125 * 128 / 4;
  int updates = 0;
  while (relative_rmse(light_of(edited.field), expected) > 0.05 && updates < 20) {
    const UpdateStatistics statistics = edited.field.update(edited.world, {.ray_budget = kBudget});
    // With one lamp, a surfel takes at most one shadow ray
    EXPECT_LE(statistics.probe_rays + statistics.shadow_rays, 2 * kBudget);
    ++updates;
  }
  EXPECT_GE(updates, 2);
  EXPECT_LE(updates, 16);  // half of them bring sleeping probes up to date
}

TEST(FieldEdit, RestsOnceItHasSettled) {
  Edited edited("furnace-sky", Edited::few(), 0);
  UpdateStatistics statistics;
  for (int i = 0; i < 60; ++i) {
    statistics = edited.field.update(edited.world, {.ray_budget = 125 * 512});
  }
  EXPECT_EQ(statistics.probe_rays, 0u);
}

std::vector<uint> words_on_threads(int threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  std::vector<uint> words;
  arena.execute([&] {
    Edited edited("cornell", Edited::few(), 2);
    edited.scene.instances.back().world_from_object[3].x += 0.3f;
    edited.follow();
    for (int i = 0; i < 3; ++i) edited.field.update(edited.world, {.ray_budget = 4000});
    words = words_of(edited.field);
  });
  return words;
}

TEST(FieldEdit, SameBitsOnAnyNumberOfThreads) {
  const std::vector<uint> one = words_on_threads(1);
  EXPECT_TRUE(words_on_threads(2) == one);
  EXPECT_TRUE(words_on_threads(4) == one);
}

TEST(FieldEdit, IsNotHeldUpByWhatLearningCorrectionsTakes) {
  Edited edited("cornell-spot");
  const double before = mean(light_of(edited.field));
  // Make new rays expensive, as if corrections were learned with them, and rays of edits cheap
  Scheduling& learned = FieldAccess::state_of(edited.field).scheduling;
  learned.ray_cost = {};
  learned.ray_cost.learn(1, 1e6, 0.0);
  learned.edit_cost = {};
  learned.edit_cost.learn_slice(1, 1e-6);
  edited.scene.lights[0].intensity *= 0.25f;
  ASSERT_TRUE(edited.world.update());
  const UpdateStatistics first = edited.field.update(edited.world, {.time_budget_ms = 1e3});
  EXPECT_GE(first.probes_invalidated, first.states.vigilant);
  // Sleeping probes follow in later updates
  EXPECT_NEAR(mean(light_of(edited.field)), 0.25 * before, 0.05 * before);
}

TEST(FieldEdit, ALampThatGoesOnAgainIsAsBrightAsItWas) {
  for (const bool corrections : {false, true}) {
    FieldSettings settings = Edited::few();
    settings.corrections = corrections;
    Edited edited("cornell-spot", settings, 24);
    const std::vector<double> before = light_of(edited.field);
    const glm::vec3 intensity = edited.scene.lights[0].intensity;
    edited.scene.lights[0].intensity = glm::vec3(0.0f);
    ASSERT_TRUE(edited.world.update());
    edited.field.update(edited.world);
    EXPECT_EQ(mean(light_of(edited.field)), 0.0);
    for (int i = 0; i < 19; ++i) edited.field.update(edited.world);
    EXPECT_EQ(mean(light_of(edited.field)), 0.0);
    edited.scene.lights[0].intensity = intensity;
    ASSERT_TRUE(edited.world.update());
    edited.field.update(edited.world);
    // Sleeping probes follow within seven updates
    EXPECT_NEAR(mean(light_of(edited.field)) / mean(before), 1.0, 0.05);
    for (int i = 0; i < 8; ++i) edited.field.update(edited.world);
    EXPECT_NEAR(mean(light_of(edited.field)) / mean(before), 1.0, 0.02);
    // The averages are lost, and corrections must be learned again
    EXPECT_LT(relative_rmse(light_of(edited.field), before), corrections ? 0.12 : 0.05);
  }
}

TEST(FieldEdit, ALampThatGoesOnBesideASmallOneIsAsBrightAsItWas) {
  // Few rays find what the small one lights, so that histories are mostly brighter than last rays
  Scene scene = scenes::make("cornell-spot").value();
  const Bounds room = open_bounds(World(scene));
  scene.materials.push_back(test::lambert(glm::vec3(0.0f), glm::vec3(5.0f)));
  const glm::vec3 place = glm::mix(room.min, room.max, glm::vec3(0.5f, 0.4f, 0.02f));
  test::add(scene, test::quad(place, {0.03f, 0, 0}, {0, 0.03f, 0},
                              static_cast<int>(scene.materials.size()) - 1));
  FieldSettings settings = Edited::few();
  settings.rays_per_probe = 32;
  settings.corrections = false;
  Edited edited(std::move(scene), settings, 24);
  const double before = mean(light_of(edited.field));
  const glm::vec3 intensity = edited.scene.lights[0].intensity;
  edited.scene.lights[0].intensity = glm::vec3(0.0f);
  ASSERT_TRUE(edited.world.update());
  for (int i = 0; i < 20; ++i) edited.field.update(edited.world);
  edited.scene.lights[0].intensity = intensity;
  ASSERT_TRUE(edited.world.update());
  edited.field.update(edited.world);
  EXPECT_NEAR(mean(light_of(edited.field)) / before, 1.0, 0.1);
  // Sleeping probes follow within seven updates. It was 1.13 while all of the history ratio held
  for (int i = 0; i < 8; ++i) edited.field.update(edited.world);
  EXPECT_NEAR(mean(light_of(edited.field)) / before, 1.0, 0.05);
}

}  // namespace
}  // namespace lambent::field_edit_test
