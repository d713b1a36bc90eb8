// SPDX-License-Identifier: Apache-2.0
// The ray tracer on a device against Embree: the same rays, the same hits.
#include "raytracing/raytracer.h"

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "core/parallel.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/world_access.h"
#include "scenes/builtin.h"
#include "support/hand_made.h"
#include "support/vulkan_device.h"
#include "twin/trace_agreement.h"

namespace lambent::raytracer_test {
namespace {

using test::expect_same_answers;
using test::random_rays;

using TracerTwin = test::OnDevice;

constexpr int kRays = 6000;

glm::mat4 at(const glm::vec3& position) {
  return glm::translate(glm::mat4(1.0f), position);
}

/// A ball in a room, and its mirror image, squashed and turned.
Scene room_with_balls() {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  test::add_room(scene, 6.0f, 0);
  test::add(scene, test::sphere(0.8f, 12, 0), at({-1.0f, 0.0f, 0.3f}));
  Instance mirrored = scene.instances.back();
  mirrored.world_from_object =
      glm::rotate(at({1.2f, 0.5f, -0.4f}), 0.7f, glm::vec3(0.3f, 1.0f, 0.2f)) *
      glm::scale(glm::mat4(1.0f), glm::vec3(-1.0f, 1.3f, 0.6f));
  scene.instances.push_back(mirrored);
  return scene;
}
constexpr std::size_t kBall = 6, kMirrored = 7;

TEST_F(TracerTwin, AnswersAsEmbreeDoesInBuiltInScenes) {
  for (const char* name : {"cornell", "two-rooms", "atrium"}) {
    SCOPED_TRACE(name);
    const Scene scene = scenes::make(name).value();
    const World on_host(scene), on_device(scene, shared_device());
    EXPECT_GT(expect_same_answers(on_device, on_host, random_rays(scene, kRays, 7u)), kRays / 3);
    const AccelerationStatistics statistics = tracer_of(on_device).statistics();
    EXPECT_EQ(statistics.triangles, triangle_count(scene));
    EXPECT_EQ(statistics.instances, scene.instances.size());
    EXPECT_GT(statistics.bytes, 0u);
    EXPECT_GT(statistics.build_ms, 0.0);
  }
}

TEST_F(TracerTwin, KnowsTheFrontOfMirroredInstances) {
  Scene scene = room_with_balls();
  const World on_host(scene), on_device(scene, shared_device());
  const std::vector<Ray> rays = random_rays(scene, kRays, 1u);
  expect_same_answers(on_device, on_host, rays);
  // Both sides of both balls are among the hits that were compared
  std::vector<Hit> hits(rays.size());
  tracer_of(on_device).closest_hits(rays, hits);
  for (const std::size_t ball : {kBall, kMirrored}) {
    for (const bool front : {false, true}) {
      EXPECT_TRUE(std::any_of(hits.begin(), hits.end(), [&](const Hit& hit) {
        return !hit.missed() && hit.instance == ball && hit.front_face == front;
      }));
    }
  }
}

TEST_F(TracerTwin, LetsRaysPassWhatTheirMasksDoNotMeet) {
  Scene scene = room_with_balls();
  scene.instances[kBall].casts_gi = false;
  scene.instances[kMirrored].ignored_by_probes = true;
  World on_host(scene), on_device(scene, shared_device());
  std::vector<Ray> rays = random_rays(scene, kRays, 2u);
  expect_same_answers(on_device, on_host, rays);
  std::swap(scene.instances[kBall].casts_gi, scene.instances[kMirrored].casts_gi);
  ASSERT_TRUE(on_host.update());
  ASSERT_TRUE(on_device.update());
  expect_same_answers(on_device, on_host, rays);
  for (Ray& ray : rays) ray.mask = 0;
  EXPECT_EQ(expect_same_answers(on_device, on_host, rays), 0);
}

TEST_F(TracerTwin, CountsHitsBetweenTheEndsOfRaysAlone) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  test::add(scene, test::quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, 0));
  const World world(scene, shared_device());
  const auto distance = [&](float t_min, float t_max) {
    const Ray ray{glm::vec3(0.0f), t_min, {0, 0, 1}, t_max};
    const Hit hit = tracer_of(world).closest_hit(ray);
    EXPECT_EQ(tracer_of(world).occluded(ray), !hit.missed());
    return hit.distance;
  };
  EXPECT_NEAR(distance(0.0f, kInfiniteDistance), 2.0f, 1e-5f);
  EXPECT_NEAR(distance(1.99f, 2.01f), 2.0f, 1e-5f);
  EXPECT_EQ(distance(0.0f, 1.99f), kInfiniteDistance);
  EXPECT_EQ(distance(2.01f, kInfiniteDistance), kInfiniteDistance);
  EXPECT_EQ(distance(3.0f, 1.0f), kInfiniteDistance);
}

TEST_F(TracerTwin, BearsScenesOfNothing) {
  Scene scene;
  World on_host(scene), on_device(scene, shared_device());
  EXPECT_EQ(expect_same_answers(on_device, on_host, random_rays(scene, 100, 3u)), 0);
  tracer_of(on_device).closest_hits({}, {});
  tracer_of(on_device).occlusions({}, {});
  // ... and their becoming scenes of something
  scene = room_with_balls();
  ASSERT_TRUE(on_host.update());
  ASSERT_TRUE(on_device.update());
  EXPECT_GT(expect_same_answers(on_device, on_host, random_rays(scene, kRays, 3u)), kRays / 3);
}

TEST_F(TracerTwin, BearsDegenerateTrianglesAndEmptyMeshes) {
  Scene scene = room_with_balls();
  Mesh& ball = scene.meshes[kBall];
  ball.triangles.insert(ball.triangles.begin(), {{0, 0, 0}, {5, 5, 9}, {3, 9, 3}});
  Mesh line = test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  for (glm::vec3& p : line.positions) p = {p.x, p.x, p.x};
  test::add(scene, line);
  Mesh empty;
  empty.material = 0;
  test::add(scene, empty);
  test::add(scene, test::sphere(0.4f, 6, 0), at({0.0f, -1.5f, 0.0f}));
  World on_host(scene), on_device(scene, shared_device());
  expect_same_answers(on_device, on_host, random_rays(scene, kRays, 4u));
}

TEST_F(TracerTwin, FollowsWhatMovesAppearsAndVanishes) {
  Scene scene = room_with_balls();
  World on_host(scene), on_device(scene, shared_device());
  const auto expect_followed = [&](const char* what) {
    SCOPED_TRACE(what);
    ASSERT_TRUE(on_host.update());
    ASSERT_TRUE(on_device.update());
    expect_same_answers(on_device, on_host, random_rays(scene, kRays, 5u));
    EXPECT_EQ(tracer_of(on_device).statistics().triangles, triangle_count(scene));
    EXPECT_EQ(tracer_of(on_device).statistics().instances, scene.instances.size());
  };
  scene.instances[kBall].world_from_object = at({-1.5f, 1.0f, 1.0f});
  expect_followed("moved");
  for (int i = 0; i < 20; ++i) {
    Instance another = scene.instances[kBall];
    another.world_from_object =
        at({-2.0f + 0.2f * static_cast<float>(i), -1.0f, static_cast<float>(i % 5) - 2.0f}) *
        glm::scale(glm::mat4(1.0f), glm::vec3(0.3f));
    scene.instances.push_back(another);
  }
  expect_followed("appeared");
  scene.instances.erase(scene.instances.begin() + kMirrored, scene.instances.begin() + 15);
  expect_followed("vanished");
  test::add(scene, test::sphere(1.1f, 9, 0), at({1.0f, 1.0f, 1.0f}));
  expect_followed("a new mesh");
}

TEST_F(TracerTwin, FollowsMeshesThatDeform) {
  Scene scene = room_with_balls();
  World on_host(scene), on_device(scene, shared_device());
  Mesh& ball = scene.meshes[kBall];
  const std::vector<glm::vec3> round = ball.positions;
  const auto expect_followed = [&](const char* what) {
    SCOPED_TRACE(what);
    ++ball.revision;
    ASSERT_TRUE(on_host.update());
    ASSERT_TRUE(on_device.update());
    expect_same_answers(on_device, on_host, random_rays(scene, kRays, 6u));
  };
  const auto bend = [&](float size, float phase) {
    for (std::size_t v = 0; v < round.size(); ++v) {
      ball.positions[v] = size * round[v] * (1.0f + 0.3f * std::sin(4.0f * round[v].y + phase));
    }
  };
  // Once built to follow, fitted, grown beyond what can be fitted
  for (int step = 0; step < 3; ++step) {
    bend(1.0f, 0.5f * static_cast<float>(step));
    expect_followed("fitted");
  }
  bend(2.0f, 0.0f);
  expect_followed("grown");
  // As many triangles of other vertices; fewer of them
  std::reverse(ball.triangles.begin(), ball.triangles.end());
  for (glm::uvec3& t : ball.triangles) t = {t.y, t.z, t.x};
  expect_followed("other triangles");
  ball.triangles.resize(ball.triangles.size() / 2);
  expect_followed("fewer");
  bend(1.0f, 0.2f);
  expect_followed("fitted again");
}

TEST_F(TracerTwin, AnswersManyThreadsAtOnce) {
  const Scene scene = room_with_balls();
  const World world(scene, shared_device());
  const std::vector<Ray> rays = random_rays(scene, 4000, 8u);
  std::vector<Hit> together(rays.size()), apart(rays.size());
  std::vector<std::uint8_t> occluded(rays.size()), occluded_apart(rays.size());
  tracer_of(world).closest_hits(rays, together);
  tracer_of(world).occlusions(rays, occluded);
  parallel_chunks(rays.size(), 61, [&](std::size_t begin, std::size_t end) {
    const auto some = std::span(rays).subspan(begin, end - begin);
    tracer_of(world).closest_hits(some, std::span(apart).subspan(begin, end - begin));
    tracer_of(world).occlusions(some, std::span(occluded_apart).subspan(begin, end - begin));
  });
  EXPECT_EQ(occluded, occluded_apart);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(together[i].distance, apart[i].distance);
    EXPECT_EQ(together[i].instance, apart[i].instance);
    EXPECT_EQ(together[i].triangle, apart[i].triangle);
  }
}

// Passes on the device trace rays that were made there, as many as it says.
TEST_F(TracerTwin, TracesBatchesThatStayOnTheDevice) {
  const Scene scene = room_with_balls();
  const World world(scene, shared_device());
  ASSERT_NE(device_world_of(world), nullptr);
  const DeviceTracer& tracer = device_world_of(world)->tracer();
  const std::vector<Ray> rays = random_rays(scene, 1000, 9u);
  constexpr std::uint32_t kTraced = 700, kUntouched = 12345u;
  const vulkan::Buffer up = vulkan::upload(device(), rays, "rays");
  const std::vector<std::uint32_t> size = {kTraced, 1, 1};
  const vulkan::Buffer indirect = vulkan::upload(device(), size, "size");
  const vulkan::Buffer hits(device(), rays.size() * sizeof(HitRecord), vulkan::Memory::device,
                            "hits");
  const vulkan::Buffer occluded(device(), rays.size() * sizeof(std::uint32_t),
                                vulkan::Memory::device, "occluded");
  device().run([&](vulkan::Recorder& recorder) {
    recorder.fill(occluded, kUntouched);
    recorder.barrier();
    RayBatch batch{{up.address()}, static_cast<std::uint32_t>(rays.size()), nullptr, 0};
    tracer.closest_hits(recorder, batch, {hits.address()});
    batch.indirect = &indirect;
    tracer.occlusions(recorder, batch, {occluded.address()});
  });
  std::vector<Hit> expected(rays.size());
  tracer_of(world).closest_hits(rays, expected);
  std::vector<std::uint8_t> expected_occluded(rays.size());
  tracer_of(world).occlusions(rays, expected_occluded);
  const auto found = vulkan::download<HitRecord>(device(), hits);
  const auto words = vulkan::download<std::uint32_t>(device(), occluded);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(missed(found[i]), expected[i].missed());
    EXPECT_EQ(words[i], i < kTraced ? expected_occluded[i] : kUntouched);
    if (missed(found[i])) continue;
    EXPECT_EQ(found[i].distance, expected[i].distance);
    EXPECT_EQ(found[i].triangle, expected[i].triangle);
    EXPECT_EQ(found[i].front_face != 0, expected[i].front_face);
  }
}

TEST(DeviceMasks, TellInstancesApartAsTheHostsDo) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].alpha_mode = AlphaMode::blend;
  scene.meshes.resize(2);
  scene.meshes[1].material = 1;
  for (const unsigned kind : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u}) {
    Instance instance;
    instance.casts_gi = (kind & 1u) != 0;
    instance.ignored_by_probes = (kind & 2u) != 0;
    instance.mesh = (kind & 4u) != 0 ? 1 : 0;
    const std::uint32_t mask = instance_mask(scene, instance);
    for (const std::uint32_t ray :
         {kRayMeetsAll, kRayGathers, kRayOfProbe, kRayOfMotion, 0u, 1u << 31}) {
      EXPECT_LT(device_mask(ray), 256u);
      EXPECT_EQ((device_mask(mask) & device_mask(ray)) != 0, (mask & ray) != 0);
    }
  }
}

}  // namespace
}  // namespace lambent::raytracer_test
