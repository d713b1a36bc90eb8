// SPDX-License-Identifier: Apache-2.0
// Rays through scenes, and whether two worlds give the same answers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent::test {

/// Distances of two ray tracers differ by rounding alone: a few units in the last place of the
/// largest coordinate that takes part.
inline constexpr float kDistanceTolerance = 1e-4f;
/// Of rays that may meet something else or nothing: those that graze an edge to within rounding.
inline constexpr double kGrazingShare = 0.001;

/// Rays from anywhere within the bounds of a scene, a little beyond them too, to everywhere; a
/// third of them with ends, and of all masks that passes use.
inline std::vector<Ray> random_rays(const Scene& scene, int count, std::uint32_t seed) {
  const Bounds bounds = world_bounds(scene);
  const glm::vec3 low = bounds.empty() ? glm::vec3(-1.0f) : bounds.min;
  const glm::vec3 size = bounds.empty() ? glm::vec3(2.0f) : bounds.max - bounds.min;
  constexpr std::uint32_t kMasks[] = {kRayMeetsAll, kRayOfProbe, kRayGathers};
  RandomStream random = make_random_stream(0u, 0u, seed);
  std::vector<Ray> rays(count);
  for (int i = 0; i < count; ++i) {
    const float x = next_uniform(random), y = next_uniform(random), z = next_uniform(random);
    const vec2 u = next_uniform2(random);
    Ray& ray = rays[i];
    ray.origin = low + size * (glm::vec3(x, y, z) * 1.2f - 0.1f);
    ray.direction = sample_uniform_sphere(u);
    ray.mask = kMasks[i % 3];
    if (i % 9 < 3) {
      ray.t_min = 0.1f * next_uniform(random) * length(size);
      ray.t_max = ray.t_min + next_uniform(random) * length(size);
    }
  }
  return rays;
}

/// Traces rays in two worlds over one scene, with closest hits and occlusions, and expects the same
/// answers but for rays that graze. Returns how many hit something.
inline int expect_same_answers(const World& ours, const World& theirs, std::span<const Ray> rays) {
  std::vector<Hit> a(rays.size()), b(rays.size());
  tracer_of(ours).closest_hits(rays, a);
  tracer_of(theirs).closest_hits(rays, b);
  std::vector<std::uint8_t> c(rays.size()), d(rays.size());
  tracer_of(ours).occlusions(rays, c);
  tracer_of(theirs).occlusions(rays, d);

  int hits = 0, grazing = 0, contradictions = 0, elsewhere = 0, reversed = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits += b[i].missed() ? 0 : 1;
    contradictions += c[i] != d[i] ? 1 : 0;
    const float off = std::abs(a[i].distance - b[i].distance);
    if (a[i].missed() != b[i].missed() ||
        (!b[i].missed() && off > kDistanceTolerance * std::max(b[i].distance, 1.0f))) {
      ++grazing;
      continue;
    }
    // Where triangles share an edge, or lie in one plane, either may be found
    if (b[i].missed() || a[i].instance != b[i].instance || a[i].triangle != b[i].triangle) continue;
    reversed += a[i].front_face != b[i].front_face ? 1 : 0;
    const Scene& scene = ours.scene();
    const Instance& instance = scene.instances[b[i].instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::uvec3 vertices = mesh.triangles[b[i].triangle];
    const auto place = [&](const glm::vec2& weights) {
      const glm::vec3 p = mesh.positions[vertices.x];
      const glm::vec3 met = p + (mesh.positions[vertices.y] - p) * weights.x +
                            (mesh.positions[vertices.z] - p) * weights.y;
      return glm::vec3(instance.world_from_object * glm::vec4(met, 1.0f));
    };
    const float apart = length(place(a[i].barycentrics) - place(b[i].barycentrics));
    elsewhere += apart > 10.0f * kDistanceTolerance * std::max(b[i].distance, 1.0f) ? 1 : 0;
  }
  const double most = kGrazingShare * static_cast<double>(rays.size());
  EXPECT_LE(grazing, most);
  EXPECT_LE(contradictions, most);
  EXPECT_LE(elsewhere, most);
  EXPECT_LE(reversed, most);
  return hits;
}

}  // namespace lambent::test
