// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <type_traits>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"
#include "support/hand_made.h"

namespace lambent::world_update_test {
namespace {

constexpr int kGrey = 0, kLamp = 1;

glm::mat4 at(const glm::vec3& position) {
  return glm::translate(glm::mat4(1.0f), position);
}

/// A room with two balls of one mesh, a third of its own, and a lamp.
Scene furnished_room() {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f)),
                     test::lambert(glm::vec3(0.0f), glm::vec3(5.0f))};
  test::add_room(scene, 10.0f, kGrey);
  test::add(scene, test::sphere(0.7f, 8, kGrey), at({-2.0f, 0.0f, 0.0f}));
  Instance second = scene.instances.back();
  second.world_from_object = at({2.0f, 0.0f, 0.0f});
  scene.instances.push_back(second);
  test::add(scene, test::sphere(0.5f, 8, kGrey), at({0.0f, 0.0f, 2.0f}));
  test::add(scene, test::quad({-0.5f, 4.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, kLamp));
  scene.lights.push_back(test::point_light(glm::vec3(10.0f), {0.0f, 3.0f, 0.0f}));
  return scene;
}
constexpr std::size_t kFirstBall = 6, kSecondBall = 7, kOwnBall = 8, kLampQuad = 9;

/// Rays in all directions from a point (a spherical Fibonacci set).
std::vector<Ray> fan(const glm::vec3& origin) {
  constexpr int kRays = 2000;
  std::vector<Ray> rays(kRays);
  for (int i = 0; i < kRays; ++i) {
    const float y = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / kRays;
    const float phi = 2.399963f * static_cast<float>(i);
    const float r = std::sqrt(1.0f - y * y);
    rays[i] = {origin, 0.0f, {r * std::cos(phi), y, r * std::sin(phi)}};
  }
  return rays;
}

std::vector<Hit> hits_of(const World& world, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  tracer_of(world).closest_hits(rays, hits);
  return hits;
}

/// The world finds what one built from nothing over the same scene finds.
void expect_as_new(const World& world) {
  const World fresh(world.scene());
  for (const glm::vec3& origin : {glm::vec3(0.0f), glm::vec3(0.3f, 2.0f, -3.0f)}) {
    const std::vector<Ray> rays = fan(origin);
    const std::vector<Hit> ours = hits_of(world, rays), theirs = hits_of(fresh, rays);
    int hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(ours[i].missed(), theirs[i].missed()) << "ray " << i;
      if (ours[i].missed()) continue;
      ++hits;
      ASSERT_NEAR(ours[i].distance, theirs[i].distance, 1e-5f) << "ray " << i;
      // Where two surfaces meet, either may be found
      if (std::abs(ours[i].distance - theirs[i].distance) > 0.0f) continue;
      ASSERT_EQ(ours[i].instance, theirs[i].instance) << "ray " << i;
      ASSERT_EQ(ours[i].front_face, theirs[i].front_face) << "ray " << i;
    }
    EXPECT_GT(hits, 1000);
  }
  EXPECT_EQ(emissive_of(world).size(), emissive_of(fresh).size());
  EXPECT_EQ(emissive_of(world).total_power(), emissive_of(fresh).total_power());
  EXPECT_EQ(tracer_of(world).statistics().triangles, tracer_of(fresh).statistics().triangles);
}

WorldChanges updated(World& world) {
  Expected<WorldChanges> changes = world.update();
  if (!changes) {
    ADD_FAILURE() << changes.error().message();
    return {};
  }
  return *changes;
}

// The scene must outlive the world, which a temporary does not.
static_assert(!std::is_constructible_v<World, Scene>);
static_assert(std::is_constructible_v<World, const Scene&>);

TEST(WorldUpdate, FindsNothingInASceneThatStaysAsItIs) {
  const Scene scene = furnished_room();
  World world(scene);
  const WorldChanges changes = updated(world);
  EXPECT_FALSE(changes.any());
  EXPECT_EQ(changes.revision, 0u);
  EXPECT_EQ(world.revision(), 0u);
  ASSERT_TRUE(world.changes_since(0));
  EXPECT_TRUE(world.changes_since(0)->empty());
}

TEST(WorldUpdate, FollowsAnInstanceThatMovesAgainAndAgain) {
  for (const std::size_t ball : {kFirstBall, kOwnBall}) {
    for (const bool dynamic : {false, true}) {
      Scene scene = furnished_room();
      scene.instances[ball].dynamic = dynamic;
      World world(scene);
      expect_as_new(world);
      for (int step = 1; step <= 3; ++step) {
        scene.instances[ball].world_from_object =
            at({0.3f * static_cast<float>(step), 1.0f, -2.0f}) *
            glm::scale(glm::mat4(1.0f), {step == 2 ? -1.0f : 1.0f, 1.0f, 0.5f});
        const WorldChanges changes = updated(world);
        EXPECT_EQ(changes.moved.size(), 2u);
        EXPECT_EQ(changes.revision, static_cast<std::uint64_t>(step));
        EXPECT_FALSE(changes.emission);
        expect_as_new(world);
      }
    }
  }
}

TEST(WorldUpdate, TellsTheBoxesBeforeAndAfterAMove) {
  Scene scene = furnished_room();
  World world(scene);
  scene.instances[kOwnBall].world_from_object = at({0.0f, 3.0f, 2.0f});
  const WorldChanges changes = updated(world);
  ASSERT_EQ(changes.moved.size(), 2u);
  EXPECT_NEAR(changes.moved[0].min.y, -0.5f, 1e-6f);
  EXPECT_NEAR(changes.moved[0].max.y, 0.5f, 1e-6f);
  EXPECT_NEAR(changes.moved[1].min.y, 2.5f, 1e-6f);
  EXPECT_NEAR(changes.moved[1].max.y, 3.5f, 1e-6f);
}

TEST(WorldUpdate, FollowsAMeshThatBends) {
  Scene scene = furnished_room();
  World world(scene);
  Mesh& ball = scene.meshes[scene.instances[kOwnBall].mesh];
  for (int step = 1; step <= 4; ++step) {
    // Small steps are refitted, the last one is large enough for a new hierarchy
    const float growth = step == 4 ? 2.0f : 1.05f;
    for (glm::vec3& p : ball.positions) p.y *= growth;
    ++ball.revision;
    const WorldChanges changes = updated(world);
    EXPECT_EQ(changes.moved.size(), 2u);
    expect_as_new(world);
  }
  // The same for a mesh that two instances share
  Mesh& shared = scene.meshes[scene.instances[kFirstBall].mesh];
  for (int step = 1; step <= 2; ++step) {
    for (glm::vec3& p : shared.positions) p.x *= 1.1f;
    ++shared.revision;
    EXPECT_EQ(updated(world).moved.size(), 4u);
    expect_as_new(world);
  }
}

TEST(WorldUpdate, FollowsAMeshThatBendsAgainWhileAnotherBendsForTheFirstTime) {
  Scene scene = furnished_room();
  World world(scene);
  Mesh& ball = scene.meshes[scene.instances[kOwnBall].mesh];
  Mesh& shared = scene.meshes[scene.instances[kFirstBall].mesh];
  for (int step = 1; step <= 3; ++step) {
    for (glm::vec3& p : ball.positions) p.y *= 1.1f;
    ++ball.revision;
    if (step > 1) {
      for (glm::vec3& p : shared.positions) p.x *= 1.1f;
      ++shared.revision;
    }
    updated(world);
    expect_as_new(world);
  }
}

TEST(WorldUpdate, FollowsAMeshThatGetsOtherTriangles) {
  Scene scene = furnished_room();
  World world(scene);
  Mesh& ball = scene.meshes[scene.instances[kFirstBall].mesh];
  ball.triangles.resize(ball.triangles.size() / 2);
  ++ball.revision;
  updated(world);
  expect_as_new(world);

  // As many as before, but others; once while it is refitted already
  Mesh& own = scene.meshes[scene.instances[kOwnBall].mesh];
  for (int step = 0; step < 2; ++step) {
    for (glm::uvec3& t : own.triangles) t = {t.z, t.y, t.x};
    own.triangles[step] = own.triangles.back();
    ++own.revision;
    updated(world);
    expect_as_new(world);
  }
}

TEST(WorldUpdate, FollowsInstancesThatComeAndGo) {
  Scene scene = furnished_room();
  World world(scene);
  Instance third = scene.instances[kFirstBall];
  third.world_from_object = at({0.0f, -2.0f, -2.0f});
  scene.instances.push_back(third);
  EXPECT_EQ(updated(world).moved.size(), 1u);
  expect_as_new(world);

  // One gone from the middle: what stands behind it in the list has not moved
  scene.instances.erase(scene.instances.begin() + kFirstBall);
  const WorldChanges gone = updated(world);
  ASSERT_EQ(gone.moved.size(), 1u);
  EXPECT_NEAR(gone.moved[0].min.x, -2.7f, 1e-5f);
  EXPECT_FALSE(gone.emission);
  expect_as_new(world);

  // One of each at once, of a mesh that is new, too
  scene.instances.pop_back();
  scene.meshes.push_back(test::quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, kGrey));
  Instance table;
  table.mesh = static_cast<int>(scene.meshes.size()) - 1;
  scene.instances.insert(scene.instances.begin(), table);
  EXPECT_EQ(updated(world).moved.size(), 2u);
  expect_as_new(world);
  EXPECT_EQ(world.revision(), 3u);
}

TEST(WorldUpdate, EmptiesAndFillsAScene) {
  Scene scene = furnished_room();
  World world(scene);
  const std::vector<Instance> all = scene.instances;
  scene.instances.clear();
  updated(world);
  EXPECT_TRUE(hits_of(world, fan(glm::vec3(0.0f)))[0].missed());
  scene.instances = all;
  updated(world);
  expect_as_new(world);
}

TEST(WorldUpdate, LogsLightsThatChangeComeAndGo) {
  Scene scene = furnished_room();
  scene.lights.push_back(test::sun(glm::vec3(1.0f), {0, -1, 0}));
  World world(scene);
  scene.lights[0].intensity *= 2.0f;
  WorldChanges changes = updated(world);
  ASSERT_EQ(changes.lights.size(), 1u);
  EXPECT_EQ(changes.lights[0].before->intensity, glm::vec3(10.0f));
  EXPECT_EQ(changes.lights[0].after->intensity, glm::vec3(20.0f));
  EXPECT_TRUE(changes.moved.empty());

  scene.lights.insert(scene.lights.begin() + 1, test::point_light(glm::vec3(3.0f), {1, 1, 1}));
  changes = updated(world);
  ASSERT_EQ(changes.lights.size(), 1u);
  EXPECT_FALSE(changes.lights[0].before);
  EXPECT_EQ(changes.lights[0].after->intensity, glm::vec3(3.0f));

  scene.lights.erase(scene.lights.begin());
  changes = updated(world);
  ASSERT_EQ(changes.lights.size(), 1u);
  EXPECT_EQ(changes.lights[0].before->intensity, glm::vec3(20.0f));
  EXPECT_FALSE(changes.lights[0].after);

  const auto log = world.changes_since(1);
  ASSERT_TRUE(log);
  ASSERT_EQ(log->size(), 2u);
  EXPECT_EQ(log->front().revision, 2u);
  EXPECT_EQ(log->back().revision, 3u);
}

TEST(WorldUpdate, KnowsWhetherAMaterialsChangeIsOneOfEmission) {
  Scene scene = furnished_room();
  World world(scene);
  scene.materials[kGrey].base_color = glm::vec4(0.2f, 0.2f, 0.2f, 1.0f);
  WorldChanges changes = updated(world);
  EXPECT_EQ(changes.materials, std::vector<int>{kGrey});
  EXPECT_FALSE(changes.emission);
  scene.materials[kLamp].emission *= 3.0f;
  changes = updated(world);
  EXPECT_EQ(changes.materials, std::vector<int>{kLamp});
  EXPECT_TRUE(changes.emission);
  EXPECT_TRUE(changes.moved.empty());
  expect_as_new(world);
}

TEST(WorldUpdate, TakesALampThatMovesForAChangeOfEmission) {
  Scene scene = furnished_room();
  World world(scene);
  scene.instances[kLampQuad].world_from_object = at({1.0f, -1.0f, 0.0f});
  EXPECT_TRUE(updated(world).emission);
  const EmissiveSample sample = emissive_of(world).sample({0.5f, 0.3f, 0.3f});
  EXPECT_NEAR(sample.position_ws.y, 3.9f, 1e-4f);
}

TEST(WorldUpdate, KeepsEmittersRightWhenTheListIsRenumbered) {
  Scene scene = furnished_room();
  World world(scene);
  scene.instances.erase(scene.instances.begin() + kSecondBall);
  EXPECT_FALSE(updated(world).emission);
  EXPECT_GT(emissive_of(world).pdf_area(kLampQuad - 1, 0, glm::vec2(0.3f)), 0.0f);
  EXPECT_EQ(emissive_of(world).pdf_area(kLampQuad, 0, glm::vec2(0.3f)), 0.0f);
}

TEST(WorldUpdate, SeesATextureAndASkyThatWereEdited) {
  Scene scene = furnished_room();
  Texture white;
  white.levels.push_back({1, 1, {255, 255, 255, 255}});
  scene.textures.push_back(white);
  scene.materials[kGrey].base_color_texture.texture = 0;
  scene.environment.map = Image(1, 1, 3);
  scene.environment.radiance = glm::vec3(1.0f);
  World world(scene);
  scene.textures[0].levels[0].rgba[0] = 9;
  ++scene.textures[0].revision;
  EXPECT_EQ(updated(world).materials, std::vector<int>{kGrey});
  scene.environment.map.pixels[0] = 2.0f;
  ++scene.environment.revision;
  EXPECT_TRUE(updated(world).environment);
  scene.environment.radiance *= 2.0f;
  EXPECT_TRUE(updated(world).environment);
  EXPECT_FALSE(updated(world).environment);
}

TEST(WorldUpdate, LetsRaysThroughWhatBecomesSeeThrough) {
  Scene scene = furnished_room();
  World world(scene);
  const Ray ray{{0.0f, 0.0f, 0.0f}, 0.0f, {0.0f, 0.0f, 1.0f}};
  EXPECT_NEAR(tracer_of(world).closest_hit(ray).distance, 1.5f, 0.05f);
  Material glass = scene.materials[kGrey];
  glass.alpha_mode = AlphaMode::mask;
  glass.base_color.a = 0.0f;
  scene.materials.push_back(glass);
  scene.meshes[scene.instances[kOwnBall].mesh].material = 2;
  EXPECT_EQ(updated(world).moved.size(), 1u);
  EXPECT_NEAR(tracer_of(world).closest_hit(ray).distance, 5.0f, 1e-4f);
  scene.materials[2].base_color.a = 1.0f;
  EXPECT_EQ(updated(world).moved.size(), 1u);
  EXPECT_NEAR(tracer_of(world).closest_hit(ray).distance, 1.5f, 0.05f);
  scene.materials[2].alpha_mode = AlphaMode::opaque;
  updated(world);
  expect_as_new(world);
}

TEST(WorldUpdate, RefusesEditsThatMakeNoSenseAndStaysAsItWas) {
  const auto refused = [](auto edit, const char* place) {
    Scene scene = furnished_room();
    World world(scene);
    edit(scene);
    const Expected<WorldChanges> changes = world.update();
    ASSERT_FALSE(changes) << place;
    EXPECT_EQ(changes.error().place, place);
    EXPECT_EQ(world.revision(), 0u);
    scene = furnished_room();
    expect_as_new(world);
    const Expected<WorldChanges> mended = world.update();
    ASSERT_TRUE(mended);
    EXPECT_FALSE(mended->any());
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  refused([](Scene& s) { s.instances[kOwnBall].mesh = 99; }, "instances[8]");
  refused([](Scene& s) { s.instances[0].mesh = -1; }, "instances[0]");
  refused([](Scene& s) { s.instances[1].world_from_object[3].x = kNan; }, "instances[1]");
  refused([](Scene& s) { s.instances[1].world_from_object = glm::mat4(0.0f); }, "instances[1]");
  refused([](Scene& s) { s.lights[0].intensity.x = kNan; }, "lights[0]");
  refused([](Scene& s) { s.materials.pop_back(); }, "meshes[8]");
  refused([](Scene& s) { s.materials[kGrey].emission.x = -1.0f; }, "materials[0]");
  refused([](Scene& s) { s.environment.radiance.x = kNan; }, "environment");
  refused(
      [](Scene& s) {
        s.meshes[2].positions[0].x = kNan;
        ++s.meshes[2].revision;
      },
      "meshes[2]");
}

TEST(WorldUpdate, ForgetsChangesBeyondTheLog) {
  Scene scene = furnished_room();
  World world(scene);
  const std::size_t updates = World::kLogLength + 3;
  for (std::size_t i = 0; i < updates; ++i) {
    scene.lights[0].intensity.x += 1.0f;
    updated(world);
  }
  EXPECT_FALSE(world.changes_since(2));
  ASSERT_TRUE(world.changes_since(3));
  EXPECT_EQ(world.changes_since(3)->size(), World::kLogLength);
  EXPECT_TRUE(world.changes_since(updates)->empty());
  EXPECT_FALSE(world.changes_since(updates + 1));
}

}  // namespace
}  // namespace lambent::world_update_test
