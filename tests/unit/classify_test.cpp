// SPDX-License-Identifier: Apache-2.0
#include "field/placement/classify.h"

#include <gtest/gtest.h>

#include "field/probes/volumes.h"
#include "raytracing/world_access.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"

namespace lambent::classify_test {
namespace {

constexpr ProbeState kAll[] = {
    ProbeState::off,   ProbeState::sleeping,       ProbeState::newly_awake,
    ProbeState::awake, ProbeState::newly_vigilant, ProbeState::vigilant};

constexpr ClassificationInput kMatter{true, true}, kSurface{false, true}, kAir{false, false};

TEST(ProbeStates, InSolidMatterAreOffFromAnyState) {
  for (const ProbeState before : kAll) {
    EXPECT_EQ(next_state(before, kMatter, false), ProbeState::off);
    EXPECT_EQ(next_state(before, kMatter, true), ProbeState::off);
  }
}

TEST(ProbeStates, NearAStaticSurfaceAreVigilantWhateverMoves) {
  for (const bool near_moving : {false, true}) {
    for (const ProbeState before : {ProbeState::off, ProbeState::sleeping, ProbeState::newly_awake,
                                    ProbeState::awake, ProbeState::newly_vigilant}) {
      EXPECT_EQ(next_state(before, kSurface, near_moving), ProbeState::newly_vigilant);
    }
    EXPECT_EQ(next_state(ProbeState::vigilant, kSurface, near_moving), ProbeState::vigilant);
  }
}

TEST(ProbeStates, InOpenAirWakeWhileSomethingMovesNear) {
  for (const ProbeState before : {ProbeState::off, ProbeState::sleeping, ProbeState::newly_awake,
                                  ProbeState::newly_vigilant, ProbeState::vigilant}) {
    EXPECT_EQ(next_state(before, kAir, true), ProbeState::newly_awake);
  }
  EXPECT_EQ(next_state(ProbeState::awake, kAir, true), ProbeState::awake);
}

TEST(ProbeStates, InOpenAirSleepWhereNothingMoves) {
  for (const ProbeState before : kAll) {
    EXPECT_EQ(next_state(before, kAir, false), ProbeState::sleeping);
  }
}

TEST(ProbeStates, AreNewUntilTraced) {
  EXPECT_EQ(state_once_traced(ProbeState::newly_awake), ProbeState::awake);
  EXPECT_EQ(state_once_traced(ProbeState::newly_vigilant), ProbeState::vigilant);
  for (const ProbeState state :
       {ProbeState::off, ProbeState::sleeping, ProbeState::awake, ProbeState::vigilant}) {
    EXPECT_EQ(state_once_traced(state), state);
  }
}

TEST(ProbeStates, MayLightWhatIsWithinACellAndTheBias) {
  const ProbeGrid grid = still_grid({vec3(0.0f), vec3(1.0f, 2.0f, 1.0f), ivec3(4)});
  // The bias is 0.225 of the smallest spacing
  const vec3 grid_position(1.0f, 2.0f, 1.0f);
  const auto box_at = [](float x, float y) {
    return Bounds{{x, y, 0.9f}, {x + 0.5f, y + 0.5f, 1.1f}};
  };
  EXPECT_TRUE(may_light(box_at(2.2f, 2.0f), grid_position, grid));
  EXPECT_FALSE(may_light(box_at(2.3f, 2.0f), grid_position, grid));
  EXPECT_TRUE(may_light(box_at(1.0f, 4.2f), grid_position, grid));
  EXPECT_FALSE(may_light(box_at(1.0f, 4.3f), grid_position, grid));
  EXPECT_FALSE(may_light(Bounds{}, grid_position, grid));
}

/// What a probe a metre from its neighbours that stands at the origin sees.
ClassificationInput reach_in(const Scene& scene) {
  const World world(scene);
  std::vector<FixedRayHit> fixed_hits(fixed_ray_directions().size());
  const Viewpoint origin{vec3(0.0f), mat3(1.0f)};
  trace_fixed_rays({scene, tracer_of(world), solid_sides_by_winding(scene), {}}, {&origin, 1},
                   fixed_hits);
  return classification_input(fixed_hits, vec3(0.0f), vec3(0.0f), vec3(1.0f));
}

TEST(ProbeReaches, TellMatterSurfacesAndAirApart) {
  using test::box_mesh;
  using test::scene_of;
  EXPECT_TRUE(reach_in(scene_of({box_mesh(vec3(-0.5f), vec3(0.5f))})).inside_geometry);
  const ClassificationInput near = reach_in(scene_of({box_mesh({0.9f, -1, -1}, {1.5f, 1, 1})}));
  EXPECT_FALSE(near.inside_geometry);
  EXPECT_TRUE(near.lights_surface);
  EXPECT_FALSE(reach_in(scene_of({box_mesh({1.1f, -1, -1}, {1.5f, 1, 1})})).lights_surface);
}

TEST(ProbeStates, OfAFieldFollowWhatMoves) {
  const ProbeStore store(still_grid({vec3(0.0f), vec3(1.0f), ivec3(4)}), {});
  std::vector<ClassificationInput> reaches(64, kAir);
  reaches[0] = kMatter;
  reaches[1] = kSurface;
  std::vector<ProbeStatus> records(64);
  const Bounds thing{vec3(2.9f), vec3(3.1f)};
  classify_probes(store, reaches, {&thing, 1}, records);
  EXPECT_EQ(records[0].state, ProbeState::off);
  EXPECT_EQ(records[1].state, ProbeState::newly_vigilant);
  EXPECT_EQ(records[2].state, ProbeState::sleeping);
  EXPECT_EQ(records[63].state, ProbeState::newly_awake);
  classify_probes(store, reaches, {}, records);
  EXPECT_EQ(records[63].state, ProbeState::sleeping);
}

TEST(ProbeStates, NearABoxAreThoseOfTheWholeField) {
  // One volume as the axes are, and one turned
  ProbeGrid grids[2];
  grids[0] = grids[1] =
      still_grid({vec3(-1.0f, 0.0f, 2.0f), vec3(1.0f, 0.5f, 2.0f), ivec3(9, 8, 7)});
  grids[1].axes = mat3(vec3(0.8f, 0.0f, -0.6f), vec3(0.0f, 1.0f, 0.0f), vec3(0.6f, 0.0f, 0.8f));
  const ProbeStore store(grids, {});
  const std::vector<ClassificationInput> reaches(store.probes(), kAir);
  std::vector<ProbeStatus> all(reaches.size()), near(reaches.size());
  Bounds before;
  classify_probes(store, reaches, {}, near);
  for (const float x : {0.0f, 1.3f, 7.5f, 30.0f}) {
    const Bounds thing{vec3(x, 1.0f, 4.0f), vec3(x + 0.5f, 1.9f, 8.0f)};
    classify_probes(store, reaches, {&thing, 1}, all);
    for (const Bounds& box : {before, thing}) {
      for (const int probe : classify_probes_near(box, store, reaches, {&thing, 1}, near)) {
        EXPECT_EQ(near[probe].state, all[probe].state);
      }
    }
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(near[i].state, all[i].state) << i;
    before = thing;
  }
}

}  // namespace
}  // namespace lambent::classify_test
