// SPDX-License-Identifier: Apache-2.0
// What edits do to the surfels of probes.
#include "field/edits/invalidation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "field/probes/volumes.h"
#include "field/transport/distances.h"
#include "raytracing/world_access.h"
#include "support/field_scenes.h"

namespace lambent::invalidation_test {
namespace {

TEST(InvalidationResult, SurfelsReadTheProbesAroundWhereTheyAreNow) {
  Scene scene = scenes::make("cornell").value();
  World world(scene);
  FieldSettings settings;
  settings.probe_count = ivec3(5);
  settings.rays_per_probe = 64;
  ProbeStore store(still_grid(fit_grid(settings, open_bounds(world)).value()), settings);
  std::vector<int> all(store.probes());
  std::iota(all.begin(), all.end(), 0);
  TraceGroup group{std::make_shared<RaySet>(settings, settings.rays_per_probe, 0u), all, {}};
  std::vector<ProbeTrace> traces(store.probes());
  trace_probe_rays(tracer_of(world), store, group);
  const SolidSides sides = solid_sides_by_winding(scene);
  blend_distances(sides, DistanceBlend(settings, group.rays->directions), group,
                  std::vector<float>(all.size(), 1.0f), 0u, store);
  shade_surfels(world, sides, store, group, settings, traces);
  find_surfel_lookups(store, {}, all, traces);
  const std::vector<ProbeTrace> before = traces;

  // The tall block moves by a third of the room
  const Bounds room = open_bounds(world);
  scene.instances.back().world_from_object[3].x += 0.33f * (room.max.x - room.min.x);
  const WorldChanges changes = world.update().value();
  const InvalidationResult followed =
      invalidate_surfels(world, sides, {&changes, 1}, settings, all, all, {}, store, traces, 0u);
  EXPECT_FALSE(followed.moved.empty());

  std::vector<ProbeTrace> expected = traces;
  find_surfel_lookups(store, {}, all, expected);
  int differ = 0;
  for (const int probe : all) {
    for (std::size_t i = 0; i < traces[probe].surfels.size(); ++i) {
      if (!traces[probe].surfels[i].reflects()) continue;
      const SurfelLookup &now = traces[probe].lookups[i], &should = expected[probe].lookups[i];
      EXPECT_EQ(now.corners.base, should.corners.base);
      EXPECT_EQ(now.tile_corner, should.tile_corner);
      EXPECT_TRUE(std::equal(std::begin(now.corners.weight), std::end(now.corners.weight),
                             std::begin(should.corners.weight)));
      differ += now.corners.base != before[probe].lookups[i].corners.base ? 1 : 0;
    }
  }
  EXPECT_GT(differ, 0);
}

}  // namespace
}  // namespace lambent::invalidation_test
