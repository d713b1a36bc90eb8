// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "support/hand_made.h"

namespace lambent::instance_flags_test {
namespace {

/// Three unit squares one behind the other, the first two of one mesh.
Scene three_squares() {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  const Mesh square = test::quad({-0.5f, -0.5f, 0.0f}, {1, 0, 0}, {0, 1, 0}, 0);
  const auto at = [](float z) {
    glm::mat4 place(1.0f);
    place[3].z = z;
    return place;
  };
  test::add(scene, square, at(1.0f));
  Instance second = scene.instances.back();
  second.world_from_object = at(2.0f);
  scene.instances.push_back(second);
  test::add(scene, square, at(3.0f));
  return scene;
}

/// Which square a ray through all of them meets first; -1: none.
int first_met(const World& world, std::uint32_t mask, float t_min) {
  const Ray ray{glm::vec3(0.0f), t_min, {0, 0, 1}, kInfiniteDistance, mask};
  const Hit hit = tracer_of(world).closest_hit(ray);
  EXPECT_EQ(tracer_of(world).occluded(ray), !hit.missed());
  return hit.missed() ? -1 : static_cast<int>(hit.instance);
}

TEST(InstanceFlags, LetRaysOfProbesAndGatheringOnesPass) {
  for (const int square : {0, 1, 2}) {  // shared meshes and a baked one
    for (const bool dynamic : {false, true}) {
      Scene scene = three_squares();
      Instance& flagged = scene.instances[square];
      flagged.dynamic = dynamic;
      World world(scene);
      const float t_min = 0.5f + static_cast<float>(square);
      const int next = square < 2 ? square + 1 : -1;
      const auto expect = [&](bool gathering_pass, bool probes_pass) {
        EXPECT_EQ(first_met(world, kRayMeetsAll, t_min), square);
        EXPECT_EQ(first_met(world, kRayGathers, t_min), gathering_pass ? next : square);
        EXPECT_EQ(first_met(world, kRayOfProbe, t_min), probes_pass ? next : square);
      };
      expect(false, false);
      flagged.ignored_by_probes = true;
      ASSERT_TRUE(world.update());
      expect(false, true);
      flagged.casts_gi = false;
      const Expected<WorldChanges> changes = world.update();
      ASSERT_TRUE(changes);
      EXPECT_EQ(changes->moved.size(), 1u);
      expect(true, true);
      // Moving does not make it forget
      flagged.world_from_object[3].x = 0.1f;
      ASSERT_TRUE(world.update());
      expect(true, true);
      flagged.casts_gi = true;
      flagged.ignored_by_probes = false;
      ASSERT_TRUE(world.update());
      expect(false, false);
    }
  }
}

TEST(InstanceFlags, ThatConcernShadingAloneAreAChangeToo) {
  Scene scene = three_squares();
  World world(scene);
  scene.instances[1].receives_gi = false;
  const Expected<WorldChanges> changes = world.update();
  ASSERT_TRUE(changes);
  EXPECT_EQ(changes->moved.size(), 1u);
  EXPECT_EQ(world.revision(), 1u);
}

}  // namespace
}  // namespace lambent::instance_flags_test
