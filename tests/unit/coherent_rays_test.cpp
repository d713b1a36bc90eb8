// SPDX-License-Identifier: Apache-2.0
// Rays that are traced together find what each finds alone.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <vector>

#include "raytracing/raytracer.h"
#include "support/hand_made.h"

namespace lambent {
namespace {

/// A room with spheres, some of them mirrored, and a net of alpha.
Scene furnished() {
  Scene scene;
  Material net = test::lambert(vec3(0.5f));
  net.alpha_mode = AlphaMode::blend;
  net.base_color.w = 0.5f;
  scene.materials = {test::lambert(vec3(0.5f)), net};
  test::add_room(scene, 10.0f, 0);
  test::add(scene, test::quad({-2.0f, -2.0f, -2.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 4.0f, 0.0f}, 1));
  test::add(scene, test::sphere(1.0f, 8, 0), glm::translate(glm::mat4(1.0f), {2.0f, 0.0f, -3.0f}));
  scene.instances.push_back(scene.instances.back());
  scene.instances.back().world_from_object =
      glm::scale(glm::translate(glm::mat4(1.0f), {-2.0f, 1.0f, -3.0f}), {-1.0f, 0.5f, 2.0f});
  scene.instances.push_back(scene.instances.back());
  scene.instances.back().dynamic = true;
  scene.instances.back().world_from_object =
      glm::scale(glm::translate(glm::mat4(1.0f), {0.0f, -2.0f, -3.0f}), {1.0f, 1.0f, -1.0f});
  return scene;
}

std::vector<Ray> rays_from_the_middle(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> spread(-1.0f, 1.0f);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.direction = glm::normalize(glm::vec3(spread(random), spread(random), -1.0f));
    ray.t_max = spread(random) > 0.0f ? kInfiniteDistance : 3.0f;
  }
  return rays;
}

TEST(CoherentRays, FindWhatTheyFindAlone) {
  const Scene scene = furnished();
  const auto tracer = make_embree_raytracer(scene);
  // Not a multiple of a packet
  const std::vector<Ray> rays = rays_from_the_middle(1001);
  std::vector<Hit> together(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  tracer->coherent_hits(rays, together);
  tracer->coherent_occlusions(rays, occluded);
  int met = 0, backs = 0, stopped = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit alone = tracer->closest_hit(rays[i]);
    EXPECT_EQ(occluded[i] != 0, tracer->occluded(rays[i])) << i;
    stopped += occluded[i];
    ASSERT_EQ(together[i].missed(), alone.missed()) << i;
    if (alone.missed()) continue;
    EXPECT_EQ(together[i].instance, alone.instance) << i;
    EXPECT_EQ(together[i].triangle, alone.triangle) << i;
    EXPECT_EQ(together[i].front_face, alone.front_face) << i;
    EXPECT_NEAR(together[i].distance, alone.distance, 1e-4f) << i;
    ++met;
    backs += alone.front_face ? 0 : 1;
  }
  EXPECT_GT(met, 400);
  EXPECT_GT(stopped, 400);
  EXPECT_LT(stopped, 1000);
  EXPECT_LT(backs, met / 4);
}

}  // namespace
}  // namespace lambent
