// SPDX-License-Identifier: Apache-2.0
#include "field/lookup/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "field/field_access.h"
#include "field/lookup/lookup.h"
#include "field/lookup/visibility_math.h"
#include "field/probes/volumes.h"
#include "first_picture/survey.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"

namespace lambent::visibility_test {
namespace {

using test::Stage;

FieldSettings settings_of(Visibility visibility) {
  FieldSettings settings;
  settings.probe_spacing = 1.0f;
  settings.rays_per_probe = 96;
  settings.visibility = visibility;
  return settings;
}

/// Mean and largest irradiance that the scene's first camera sees.
vec2 seen_irradiance(const Stage& stage, Visibility visibility) {
  const IrradianceField field = test::make_field(stage, settings_of(visibility), 2);
  const std::vector<FieldQuery> queries = test::seen_points(stage);
  std::vector<vec3> irradiance(queries.size());
  field.irradiance(queries, irradiance, &stage.world);
  float sum = 0.0f, largest = 0.0f;
  for (const vec3& e : irradiance) {
    sum += e.y;
    largest = max(largest, e.y);
  }
  return {sum / static_cast<float>(irradiance.size()), largest};
}

TEST(Visibility, HybridAndExactAreDarkBehindASealedWall) {
  const Stage open("two-rooms"), sealed("two-rooms-sealed");
  const float lit = seen_irradiance(open, Visibility::hybrid).x;
  ASSERT_GT(lit, 0.0f);
  for (const Visibility visibility : {Visibility::hybrid, Visibility::exact}) {
    const vec2 dark = seen_irradiance(sealed, visibility);
    EXPECT_LT(dark.x, 1e-4f * lit);
    EXPECT_LT(dark.y, 1e-3f * lit);
  }
}

TEST(Visibility, MomentsAreNearlyDarkBehindASealedWall) {
  const Stage open("two-rooms"), sealed("two-rooms-sealed");
  const float lit = seen_irradiance(open, Visibility::moments).x;
  const vec2 dark = seen_irradiance(sealed, Visibility::moments);
  EXPECT_LT(dark.x, 3e-3f * lit);
  EXPECT_LT(dark.y, 2e-2f * lit);
}

/// A field with all that its lookups need.
struct Traced {
  explicit Traced(const Stage& stage)
      : field(test::make_field(stage, settings_of(Visibility::moments), 1)),
        cell_visibility(store_of(field).probes()) {
    std::vector<int> probes(store_of(field).probes());
    std::iota(probes.begin(), probes.end(), 0);
    rays = cell_visibility.update(tracer_of(stage.world), store_of(field), probes);
  }
  std::vector<CornerWeights> weights(const Stage& stage, Visibility mode,
                                     std::span<const FieldQuery> queries) const {
    std::vector<CornerWeights> result(queries.size());
    visible_corner_weights(store_of(field), 0, {mode, &tracer_of(stage.world), &cell_visibility},
                           queries, result);
    return result;
  }
  IrradianceField field;
  CellVisibility cell_visibility;
  std::uint64_t rays = 0;
};

bool same(const CornerWeights& a, const CornerWeights& b) {
  return a.base == b.base && std::equal(a.weight, a.weight + 8, b.weight);
}

TEST(Visibility, HybridEqualsMomentsWithoutARayWhereAllProbesSeeEachOther) {
  const Stage stage("furnace");
  const Traced traced(stage);
  const std::vector<FieldQuery> queries = test::seen_points(stage);
  const auto moments = traced.weights(stage, Visibility::moments, queries);
  const auto hybrid = traced.weights(stage, Visibility::hybrid, queries);
  int open = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (traced.cell_visibility.of_cell(moments[i].base) != all_visible()) continue;
    ++open;
    EXPECT_TRUE(same(hybrid[i], moments[i])) << i;
  }
  EXPECT_GT(open, 100);
}

/// Two rooms on both sides of a wall of 4 cm with a doorway, whose door is ajar.
Scene rooms_with_a_door_ajar() {
  Mesh door = test::box_mesh({0.0f, -3.0f, 0.0f}, {0.04f, -1.0f, 0.9f});
  for (glm::vec3& p : door.positions)
    p = {0.77f * p.x + 0.64f * p.z, p.y, 0.77f * p.z - 0.64f * p.x};
  Scene scene = test::scene_of({test::box_mesh(vec3(-3.0f), vec3(3.0f), true),
                                test::box_mesh({-0.02f, -3.0f, -3.0f}, {0.02f, 3.0f, 0.0f}),
                                test::box_mesh({-0.02f, -3.0f, 0.9f}, {0.02f, 3.0f, 3.0f}),
                                test::box_mesh({-0.02f, -1.0f, 0.0f}, {0.02f, 3.0f, 0.9f}), door});
  scene.environment.radiance = vec3(1.0f);
  return scene;
}

/// Points of wall and door, seen by viewers at both sides of their normals.
std::vector<FieldQuery> points_at_the_door(const Scene& scene) {
  const std::uint32_t parts[] = {1, 2, 3, 4};
  std::vector<FieldQuery> queries;
  for (const SurfaceSample& point : sample_surfaces(scene, parts, 40000)) {
    const float turn = static_cast<float>(queries.size());
    const vec3 aside(std::cos(turn), 0.0f, std::sin(turn));
    queries.push_back(
        {point.position_ws, point.normal_ws, normalize(point.normal_ws + 0.9f * aside)});
  }
  return queries;
}

TEST(Visibility, HybridDropsTheHeaviestProbeWhereARayFindsItHiddenAndAnotherOneSeen) {
  const Stage stage(rooms_with_a_door_ajar());
  const Traced traced(stage);
  const ProbeStore& store = store_of(traced.field);
  const ProbeGrid& grid = store.grid(0);
  const float smallest = std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
  const std::vector<FieldQuery> queries = points_at_the_door(stage.world.scene());
  const auto moments = traced.weights(stage, Visibility::moments, queries);
  const auto hybrid = traced.weights(stage, Visibility::hybrid, queries);
  const CornerOffsets& offsets = store.corner_table()[0];
  int dropped = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const FieldQuery& q = queries[i];
    const vec3 start =
        biased_position(q.position_ws, q.normal_ws, q.to_viewer_ws, q.viewer_distance, smallest);
    const auto sees = [&](int corner) {
      const vec3 way = store.probe_position_ws(moments[i].base + offsets.probe[corner]) - start;
      return !tracer_of(stage.world).occluded({start, 0.0f, normalize(way), length(way)});
    };
    const int heaviest = heaviest_corner(moments[i]);
    const uint mutual = corners_seen_by(traced.cell_visibility.of_cell(moments[i].base), heaviest);
    bool contested = false;
    for (int k = 0; k < 8; ++k) {
      const bool counts = moments[i].weight[k] >= kMinTestedWeight;
      contested = contested || (counts && (mutual >> k & 1u) == 0u && sees(k));
    }
    if (!contested || sees(heaviest)) continue;
    ++dropped;
    EXPECT_EQ(hybrid[i].weight[heaviest], 0.0f) << i;
  }
  EXPECT_GT(dropped, 20);
}

TEST(Visibility, HybridBelievesTheHeaviestProbeWhereRaysReachNone) {
  CornerWeights corners{};
  corners.weight[0] = 0.6f;
  corners.weight[1] = 0.25f;
  corners.weight[2] = 0.15f;
  // Corner 0 sees 1, and neither sees 2
  uvec2 cell = without_pair(without_pair(all_visible(), {0, 2}), {1, 2});
  const VisibilityMask mask = visibility_mask(corners, cell, 1.0f);
  EXPECT_EQ(mask.tested, 7u);
  EXPECT_EQ(mask.hidden, 0u);
  const CornerWeights none = tested_weights(corners, 7u, cell, 1.0f);
  EXPECT_NEAR(none.weight[0], 0.6f / 0.85f, 1e-6f);
  EXPECT_NEAR(none.weight[1], 0.25f / 0.85f, 1e-6f);
  EXPECT_EQ(none.weight[2], 0.0f);
  const CornerWeights last = tested_weights(corners, 3u, cell, 1.0f);
  EXPECT_EQ(last.weight[2], 1.0f);
}

TEST(Visibility, HybridFallsBackToMomentsWithoutAWorld) {
  const Stage stage("two-rooms");
  const Traced traced(stage);
  const std::vector<FieldQuery> queries = test::seen_points(stage);
  std::vector<CornerWeights> result(queries.size());
  visible_corner_weights(store_of(traced.field), 0,
                         {Visibility::hybrid, nullptr, &traced.cell_visibility}, queries, result);
  const auto moments = traced.weights(stage, Visibility::moments, queries);
  for (std::size_t i = 0; i < queries.size(); ++i) EXPECT_TRUE(same(result[i], moments[i]));
}

TEST(Visibility, ExactCountsTheProbesThatARayReachesAndNoOthers) {
  const Stage stage("two-rooms");
  const Traced traced(stage);
  const ProbeStore& store = store_of(traced.field);
  const ProbeGrid& grid = store.grid(0);
  const float smallest = std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
  const std::vector<FieldQuery> queries = test::seen_points(stage);
  const auto exact = traced.weights(stage, Visibility::exact, queries);
  const CornerOffsets& offsets = store.corner_table()[0];
  int hidden = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const FieldQuery& q = queries[i];
    const ProbeCell cell = probe_cell(grid, q.position_ws);
    const vec3 start =
        biased_position(q.position_ws, q.normal_ws, q.to_viewer_ws, q.viewer_distance, smallest);
    float expected[8], sum = 0.0f;
    for (int k = 0; k < 8; ++k) {
      const int probe = exact[i].base + offsets.probe[k];
      const vec3 place = store.probe_position_ws(probe);
      const vec3 to_probe = place - start;
      const bool seen =
          !tracer_of(stage.world).occluded({start, 0.0f, normalize(to_probe), length(to_probe)});
      const bool known = store.moments(probe, normalize(start - place)).x > 0.0f;
      const float wrap = wrap_weight(dot(normalize(place - q.position_ws), q.normal_ws));
      const float weight = trilinear_weight(cell.fraction, cell_corner(k));
      hidden += !seen && wrap * weight > 0.0f ? 1 : 0;
      expected[k] = seen && known && wrap > 0.0f ? weight * combined_weight(wrap, 1.0f) : 0.0f;
      sum += expected[k];
    }
    if (sum <= 0.0f) continue;
    for (int k = 0; k < 8; ++k) EXPECT_NEAR(exact[i].weight[k], expected[k] / sum, 1e-3f) << i;
  }
  EXPECT_GT(hidden, 10);
}

/// A room without openings, with walls of 4 cm, in a wide court under a bright sky.
Scene sealed_room_in_the_open() {
  Scene scene = test::scene_of({test::box_mesh(vec3(-2.44f), vec3(2.44f)),
                                test::box_mesh(vec3(-2.4f), vec3(2.4f), true),
                                test::box_mesh({-6.0f, -2.6f, -6.0f}, {6.0f, -2.5f, 6.0f}),
                                test::box_mesh({5.9f, -2.5f, -6.0f}, {6.0f, 3.0f, 6.0f})});
  scene.environment.radiance = vec3(1.0f);
  return scene;
}

TEST(Visibility, TheWayToAViewerNearbyIsNotFollowedThroughTheWallBehindHim) {
  const Stage stage(sealed_room_in_the_open());
  const IrradianceField field = test::make_field(stage, settings_of(Visibility::exact), 2);
  // A ray from one wall to the other, in their corner
  const vec3 from(2.35f, 0.0f, 2.4f), to(2.4f, 0.0f, 2.3f);
  FieldQuery query{to, {-1.0f, 0.0f, 0.0f}, normalize(from - to)};
  const auto irradiance = [&] {
    vec3 found(0.0f);
    field.irradiance({&query, 1}, {&found, 1}, &stage.world);
    return found.y;
  };
  ASSERT_GT(irradiance(), 0.1f);  // of a viewer far away, who could not be there
  query.viewer_distance = length(from - to);
  EXPECT_LT(irradiance(), 1e-3f);
}

TEST(CellVisibility, KnowWhichProbesOfACellAWallParts) {
  const Scene wall = test::scene_of({test::box_mesh({-9.0f, -9.0f, 0.4f}, {9.0f, 9.0f, 0.6f})});
  const World world(wall);
  const ProbeStore store(still_grid({vec3(0.0f), vec3(1.0f), ivec3(2, 2, 3)}), FieldSettings{});
  CellVisibility cell_visibility(store.probes());
  const int probes[] = {0, 1, 4, 8};
  // Two cells of 28 pairs each; the others' lowest probes are beyond the grid's last cell
  EXPECT_EQ(cell_visibility.update(tracer_of(world), store, probes), 56u);
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k) {
      const bool seen = (corners_seen_by(cell_visibility.of_cell(0), i) >> k & 1u) != 0;
      EXPECT_EQ(seen, (i < 4) == (k < 4)) << i << " " << k;
    }
  }
  EXPECT_EQ(cell_visibility.of_cell(4), all_visible());
}

}  // namespace
}  // namespace lambent::visibility_test
