// SPDX-License-Identifier: Apache-2.0
#include "field/placement/relocate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <numeric>

#include "field/field_access.h"
#include "field/lookup/visibility.h"
#include "field/probes/volumes.h"
#include "raytracing/world_access.h"
#include "shared/random.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"

namespace lambent::relocate_test {
namespace {

using test::box_mesh;
using test::scene_of;
using test::Stage;

// The distance at which probes stand in front of surfaces, and its tolerance, in smallest spacings.
constexpr float kMargin = 0.15f, kOff = 0.06f;

/// Eight probes a metre apart, of which the last stands at (0, 0, 0).
ProbeStore one_cell() {
  return {still_grid({vec3(-1.0f), vec3(1.0f), ivec3(2)}), FieldSettings{}};
}
constexpr int kAtOrigin = 7;

vec3 relocated(const Scene& scene, std::span<const std::uint8_t> moving = {}) {
  const World world(scene);
  ProbeStore store = one_cell();
  relocate_probes({scene, tracer_of(world), solid_sides_by_winding(scene), moving}, {&kAtOrigin, 1},
                  store);
  return store.probe_position_ws(kAtOrigin);
}

std::vector<int> all_probes(const ProbeStore& store) {
  std::vector<int> probes(store.probes());
  std::iota(probes.begin(), probes.end(), 0);
  return probes;
}

TEST(Relocation, LeavesABoxByTheShortestWay) {
  const vec3 place = relocated(scene_of({box_mesh({-2.0f, -2.0f, -2.0f}, {0.2f, 2.0f, 2.0f})}));
  EXPECT_NEAR(place.x, 0.2f + kMargin, kOff);
  EXPECT_LT(glm::length(vec2(place.y, place.z)), 0.2f);
}

TEST(Relocation, StaysInABoxItCannotLeave) {
  EXPECT_EQ(relocated(scene_of({box_mesh(vec3(-2.0f), vec3(2.0f))})), vec3(0.0f));
}

TEST(Relocation, ComesToTheFrontOfAWall) {
  const vec3 place = relocated(scene_of({box_mesh({0.4f, -9.0f, -9.0f}, {0.6f, 9.0f, 9.0f})}));
  EXPECT_NEAR(place.x, 0.4f - kMargin, kOff);
  EXPECT_NEAR(place.y, 0.0f, 1e-3f);
  EXPECT_NEAR(place.z, 0.0f, 1e-3f);
}

TEST(Relocation, KeepsOffAWallThatIsTooNear) {
  const vec3 place = relocated(scene_of({box_mesh({0.02f, -9.0f, -9.0f}, {0.6f, 9.0f, 9.0f})}));
  EXPECT_NEAR(place.x, 0.02f - kMargin, kOff);
}

TEST(Relocation, ComesIntoTheCornerOfARoom) {
  const vec3 place =
      relocated(scene_of({box_mesh({-9.0f, -0.3f, -9.0f}, {0.4f, 9.0f, 0.35f}, true)}));
  EXPECT_NEAR(place.x, 0.4f - kMargin, kOff);
  EXPECT_NEAR(place.y, -0.3f + kMargin, kOff);
  EXPECT_NEAR(place.z, 0.35f - kMargin, kOff);
}

TEST(Relocation, StandsInTheMiddleOfANarrowGap) {
  const Scene gap = scene_of({box_mesh({-0.5f, -9.0f, -9.0f}, {-0.12f, 9.0f, 9.0f}),
                              box_mesh({0.04f, -9.0f, -9.0f}, {0.5f, 9.0f, 9.0f})});
  EXPECT_NEAR(relocated(gap).x, -0.04f, 0.03f);
}

TEST(Relocation, StaysWhereNothingIsNear) {
  EXPECT_EQ(relocated(scene_of({box_mesh({3.0f, 3.0f, 3.0f}, {4.0f, 4.0f, 4.0f})})), vec3(0.0f));
}

TEST(Relocation, LooksThroughWhatMoves) {
  const Scene wall = scene_of({box_mesh({0.4f, -9.0f, -9.0f}, {0.6f, 9.0f, 9.0f})});
  const std::uint8_t moving[] = {1};
  EXPECT_EQ(relocated(wall, moving), vec3(0.0f));
}

/// Random boxes of all sizes that intersect each other, so that no place is good.
Scene clutter() {
  RandomStream random = make_random_stream(7, 8, 9);
  std::vector<Mesh> boxes;
  for (int i = 0; i < 300; ++i) {
    const vec3 low = 5.0f * vec3(next_uniform2(random), next_uniform(random));
    const vec3 size = 0.05f + 0.6f * vec3(next_uniform2(random), next_uniform(random));
    boxes.push_back(box_mesh(low, low + size));
  }
  return scene_of(std::move(boxes));
}

std::vector<vec3> offsets_in(const Stage& stage, int rounds, int threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  std::vector<vec3> offsets;
  arena.execute([&] {
    ProbeStore store(still_grid({vec3(0.0f), vec3(0.9f, 1.0f, 1.1f), ivec3(6)}), FieldSettings{});
    const SolidSides sides = solid_sides_by_winding(stage.scene);
    for (int i = 0; i < rounds; ++i) {
      relocate_probes({stage.scene, tracer_of(stage.world), sides, {}}, all_probes(store), store);
    }
    for (int i = 0; i < store.probes(); ++i) offsets.push_back(store.probe_offset(i));
  });
  return offsets;
}

TEST(Relocation, ComesToRestWithinItsCellTheSameOnAnyNumberOfThreads) {
  const Stage stage(clutter());
  const std::vector<vec3> once = offsets_in(stage, 1, 1);
  EXPECT_EQ(offsets_in(stage, 1, 4), once);
  EXPECT_EQ(offsets_in(stage, 3, 2), once);
  int moved = 0;
  for (const vec3& offset : once) {
    const vec3 a = abs(offset);
    EXPECT_LE(std::max({a.x, a.y, a.z}), kMaxProbeOffset * 1.0001f);
    moved += offset != vec3(0.0f) ? 1 : 0;
  }
  EXPECT_GT(moved, 20);
}

/// A ray tracer that prefers large batches, like devices, and counts its batches.
class FarTracer final : public RayTracer {
 public:
  explicit FarTracer(const RayTracer& near) : near_(near) {}
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const override {
    near_.closest_hits(rays, hits);
    ++batches;
  }
  void occlusions(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const override {
    near_.occlusions(rays, occluded);
    ++batches;
  }
  std::size_t batch_rays() const override { return 1u << 18; }
  AccelerationStatistics statistics() const override { return near_.statistics(); }
  void update(const GeometryEdits&) override {}

  mutable std::atomic<int> batches = 0;

 private:
  const RayTracer& near_;
};

TEST(Relocation, ComesToTheSamePlacesInBatchesOfAnySize) {
  const Stage stage(clutter());
  std::vector<std::uint8_t> moving(stage.scene.instances.size(), 0);
  for (std::size_t i = 0; i < moving.size(); i += 3) moving[i] = 1;
  const FarTracer far(tracer_of(stage.world));
  const SolidSides sides = solid_sides_by_winding(stage.scene);
  const auto offsets = [&](const RayTracer& tracer) {
    ProbeStore store(still_grid({vec3(0.0f), vec3(0.9f, 1.0f, 1.1f), ivec3(6)}), FieldSettings{});
    relocate_probes({stage.scene, tracer, sides, moving}, all_probes(store), store);
    return std::vector<uint>(store.offset_words().begin(), store.offset_words().end());
  };
  EXPECT_EQ(offsets(far), offsets(tracer_of(stage.world)));
  // The number of batches is about the number of steps of the probe that takes most, and a few more
  // per step for moving instances in the rays' way
  EXPECT_LT(far.batches, 300);
  EXPECT_GT(far.batches, 1);

  ProbeStore store(still_grid({vec3(0.0f), vec3(0.9f, 1.0f, 1.1f), ivec3(6)}), FieldSettings{});
  CellVisibility near_sights(store.probes()), far_sights(store.probes());
  far.batches = 0;
  EXPECT_EQ(near_sights.update(tracer_of(stage.world), store, all_probes(store)),
            far_sights.update(far, store, all_probes(store)));
  EXPECT_EQ(far.batches, 1);
  for (const int probe : all_probes(store)) {
    EXPECT_EQ(near_sights.of_cell(probe), far_sights.of_cell(probe));
  }
}

TEST(Relocation, TellsWhichProbesMoved) {
  const Scene wall = scene_of({box_mesh({0.4f, -9.0f, -9.0f}, {0.6f, 9.0f, 9.0f})});
  const World world(wall);
  ProbeStore store = one_cell();
  const SolidSides sides = solid_sides_by_winding(wall);
  const StaticScene still = {wall, tracer_of(world), sides, {}};
  // Probes at x = -1 m are too far from the wall
  EXPECT_EQ(relocate_probes(still, all_probes(store), store), (std::vector<int>{1, 3, 5, 7}));
  EXPECT_TRUE(relocate_probes(still, all_probes(store), store).empty());
}

TEST(Relocation, IsASettingOfTheField) {
  const Stage stage("cornell");
  FieldSettings settings;
  settings.probe_count = ivec3(5);
  const auto moved = [&] {
    const IrradianceField field = test::make_field(stage, settings, 1);
    const auto words = store_of(field).offset_words();
    return std::any_of(words.begin(), words.end(), [](uint word) { return word != 0u; });
  };
  EXPECT_TRUE(moved());
  settings.relocation = false;
  EXPECT_FALSE(moved());
}

}  // namespace
}  // namespace lambent::relocate_test
