// SPDX-License-Identifier: Apache-2.0
// What edits do to the surfels of probes.
#include "field/edits/invalidation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "field/probes/volumes.h"
#include "field/transport/distances.h"
#include "raytracing/world_access.h"
#include "scene/texture.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::invalidation_test {
namespace {

using ::testing::FloatNear;
using ::testing::Pointwise;

/// A room whose probes have been traced once.
class TracedRoom {
 public:
  explicit TracedRoom(Scene made)
      : scene_(std::move(made)),
        world(scene_),
        settings(settings_of_room()),
        store(still_grid(fit_grid(settings, open_bounds(world)).value()), settings) {
    all.resize(store.probes());
    std::iota(all.begin(), all.end(), 0);
    group = {std::make_shared<RaySet>(settings, settings.rays_per_probe, 0u), all, {}};
    sides = solid_sides_by_winding(scene_);
    traces = trace();
    blend_distances(sides, DistanceBlend(settings, group.rays->directions), group,
                    std::vector<float>(all.size(), 1.0f), 0u, store);
    find_surfel_lookups(store, {}, all, traces);
  }

  /// The surfels of new hits of the same rays.
  std::vector<ProbeTrace> trace() {
    std::vector<ProbeTrace> found(store.probes());
    trace_probe_rays(tracer_of(world), store, group);
    shade_surfels(world, sides, store, group, settings, found);
    return found;
  }

  /// Moves the tall block by a third of the room, and brings the surfels up to date.
  InvalidationResult move_block() {
    const Bounds room = open_bounds(world);
    scene_.instances.back().world_from_object[3].x += 0.33f * (room.max.x - room.min.x);
    return follow_edits();
  }

  /// Moves a light, and brings the surfels up to date.
  InvalidationResult move_light() {
    scene_.lights.at(0).position_ws.x += 0.1f;
    return follow_edits();
  }

  /// Gives the red wall another material, and brings the surfels up to date.
  InvalidationResult paint_red_wall(const Material& paint) {
    for (Material& material : scene_.materials) {
      if (material.name == "red") material = paint;
    }
    return follow_edits();
  }

 private:
  InvalidationResult follow_edits() {
    const WorldChanges changes = world.update().value();
    return invalidate_surfels(world, sides, {&changes, 1}, settings, all, all, {}, store, traces,
                              0u);
  }

  static FieldSettings settings_of_room() {
    FieldSettings settings;
    settings.probe_count = ivec3(5);
    settings.rays_per_probe = 64;
    return settings;
  }
  Scene scene_;

 public:
  World world;
  FieldSettings settings;
  ProbeStore store;
  std::vector<int> all;  ///< Indices of all probes.
  TraceGroup group;
  SolidSides sides;
  std::vector<ProbeTrace> traces;
};

TEST(InvalidationResult, SurfelsReadTheProbesAroundWhereTheyAreNow) {
  TracedRoom room(scenes::make("cornell").value());
  const std::vector<ProbeTrace> before = room.traces;
  EXPECT_FALSE(room.move_block().moved.empty());

  std::vector<ProbeTrace> expected = room.traces;
  find_surfel_lookups(room.store, {}, room.all, expected);
  int differ = 0;
  for (const int probe : room.all) {
    for (std::size_t i = 0; i < expected[probe].surfels.size(); ++i) {
      if (!expected[probe].surfels[i].reflects()) continue;
      const SurfelLookup &now = room.traces[probe].lookups[i], &should = expected[probe].lookups[i];
      EXPECT_EQ(now.corners.base, should.corners.base);
      EXPECT_EQ(now.tile_corner, should.tile_corner);
      EXPECT_TRUE(std::equal(std::begin(now.corners.weight), std::end(now.corners.weight),
                             std::begin(should.corners.weight)));
      differ += now.corners.base != before[probe].lookups[i].corners.base ? 1 : 0;
    }
  }
  EXPECT_GT(differ, 0);
}

TEST(InvalidationResult, SurfelsThatMirrorsShowAreThoseOfAFreshTrace) {
  Scene scene = scenes::make("cornell").value();
  for (Material& material : scene.materials) {
    if (material.name != "red") continue;
    material = {};  // a metal
    material.roughness = 0.1f;
  }
  TracedRoom room(std::move(scene));
  const std::vector<ProbeTrace> before = room.traces;
  room.move_block();
  const std::vector<ProbeTrace> fresh = room.trace();
  int mirrored = 0;
  for (const int probe : room.all) {
    for (std::size_t i = 0; i < fresh[probe].surfels.size(); ++i) {
      const Surfel& surfel = fresh[probe].surfels[i];
      if (surfel.mirror_distance <= 0.0f) continue;
      EXPECT_TRUE(room.traces[probe].surfels[i] == surfel) << probe << ", ray " << i;
      mirrored += surfel != before[probe].surfels[i] ? 1 : 0;
    }
  }
  EXPECT_GT(mirrored, 0);
}

TEST(InvalidationResult, LightOnBumpsIsThatOfAFreshTrace) {
  // A bumpy panel in the room, and a lamp
  Scene scene = scenes::make("cornell").value();
  Material bumpy = test::lambert(glm::vec3(0.7f));
  bumpy.normal_texture.texture = 0;
  scene.materials.push_back(bumpy);
  Texture texture;
  texture.levels.resize(1);
  texture.levels[0].width = texture.levels[0].height = 32;
  for (int i = 0; i < 32 * 32; ++i) {
    const std::uint8_t lean = (i + i / 32) / 4 % 2 == 0 ? 40 : 215;
    texture.levels[0].rgba.insert(texture.levels[0].rgba.end(), {lean, 128, 220, 255});
  }
  build_normal_mips(texture);
  scene.textures = {std::move(texture)};
  const Bounds room_box = open_bounds(World(scene));
  const vec3 size = room_box.max - room_box.min, center = 0.5f * (room_box.min + room_box.max);
  test::add(scene, test::quad(center, {0.4f * size.x, 0.0f, 0.0f}, {0.0f, 0.4f * size.y, 0.0f},
                              static_cast<int>(scene.materials.size()) - 1));
  Light lamp;
  lamp.position_ws = center + 0.3f * vec3(0.0f, size.y, size.z);
  scene.lights = {lamp};

  TracedRoom room(std::move(scene));
  const std::vector<ProbeTrace> before = room.traces;
  room.move_light();
  const std::vector<ProbeTrace> fresh = room.trace();
  int lit = 0;
  for (const int probe : room.all) {
    for (std::size_t i = 0; i < fresh[probe].surfels.size(); ++i) {
      const Surfel &surfel = fresh[probe].surfels[i], &found = room.traces[probe].surfels[i];
      if (surfel.gi_share == 0.0f || surfel.gi_share > 0.98f) continue;
      if (surfel.light == before[probe].surfels[i].light) continue;
      EXPECT_THAT(std::span(&found.light.x, 3),
                  Pointwise(FloatNear(1e-3f * surfel.light.x), std::span(&surfel.light.x, 3)));
      ++lit;
    }
  }
  EXPECT_GT(lit, 10);
}

TEST(InvalidationResult, AWallThatBecomesAMirrorKeepsItsDistances) {
  TracedRoom room(scenes::make("cornell").value());
  const auto mean_distances = [&] {
    std::vector<float> means;
    for (const int probe : room.all) {
      const int edge = room.store.distance_texels();
      for (int t = 0; t < edge * edge; ++t) {
        means.push_back(room.store.moments_texel(probe, ivec2(t % edge, t / edge) + 1).x);
      }
    }
    return means;
  };
  const std::vector<float> means_before = mean_distances();
  Material mirror;
  mirror.name = "red";
  mirror.roughness = 0.1f;
  room.paint_red_wall(mirror);
  const std::vector<ProbeTrace> fresh = room.trace();
  int mirrored = 0;
  for (const int probe : room.all) {
    for (std::size_t i = 0; i < fresh[probe].surfels.size(); ++i) {
      if (fresh[probe].surfels[i].mirror_distance <= 0.0f) continue;
      ++mirrored;
      EXPECT_TRUE(room.traces[probe].surfels[i] == fresh[probe].surfels[i]) << probe << ", " << i;
    }
  }
  EXPECT_GT(mirrored, 0);
  // Distances along rays and between points differ by rounding, which 16 bits of a float hide
  EXPECT_THAT(mean_distances(), Pointwise(FloatNear(2e-3f), means_before));
}

}  // namespace
}  // namespace lambent::invalidation_test
