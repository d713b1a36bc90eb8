// SPDX-License-Identifier: Apache-2.0
// Where a scene's open space ends: its bounds without the walls around it.
#include <algorithm>
#include <utility>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"

namespace lambent {
namespace {

// Rays along each edge of a side of the bounds.
constexpr int kRaysAlongEdge = 24;
// Walls thicker than this share of the scene are not walls but what the scene is about.
constexpr float kMaxWallShare = 0.1f;
// A side is walled where at least this share of its rays pass through a wall.
constexpr float kMinWalledShare = 0.5f;
// Rays start this share of the scene outside of it.
constexpr float kStartShare = 0.01f;
// Further on by this share of the way, a ray has left the surface it met behind.
constexpr float kPastSurface = 1e-5f;
// Surfaces that a ray may pass before it counts as lost in a thicket.
constexpr int kMaxSurfaces = 16;

/// How deep below the starts of rays the solid matter that each meets first ends, of those where it
/// does. Rays go on through surfaces together.
std::vector<float> depths_of_wall(const World& world, std::vector<Ray> rays) {
  const Scene& scene = world.scene();
  std::vector<float> depths;
  std::vector<Hit> hits;
  for (int i = 0; i < kMaxSurfaces && !rays.empty(); ++i) {
    hits.assign(rays.size(), {});
    world.tracer().closest_hits(rays, hits);
    std::size_t left = 0;
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const Hit& hit = hits[r];
      if (hit.missed()) continue;
      // The far side of a wall, or a single sheet that faces inwards, is met from behind
      const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
      if (!hit.front_face || scene.materials[mesh.material].double_sided) {
        depths.push_back(hit.distance);
        continue;
      }
      rays[left] = rays[r];
      rays[left++].t_min = hit.distance * (1.0f + kPastSurface);
    }
    rays.resize(left);
  }
  return depths;
}

/// How far the open space keeps from a side of the bounds.
float wall_thickness(const World& world, const Bounds& bounds, int axis, bool upper) {
  const glm::vec3 size = bounds.max - bounds.min;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const float start = kStartShare * size[axis];
  std::vector<Ray> rays(kRaysAlongEdge * kRaysAlongEdge);
  for (int i = 0; i < kRaysAlongEdge * kRaysAlongEdge; ++i) {
    Ray& ray = rays[i];
    ray.direction = glm::vec3(0.0f);
    ray.direction[axis] = upper ? -1.0f : 1.0f;
    ray.origin[axis] = upper ? bounds.max[axis] + start : bounds.min[axis] - start;
    ray.origin[u] =
        bounds.min[u] + size[u] * (static_cast<float>(i % kRaysAlongEdge) + 0.5f) / kRaysAlongEdge;
    ray.origin[v] =
        bounds.min[v] + size[v] * (static_cast<float>(i / kRaysAlongEdge) + 0.5f) / kRaysAlongEdge;
    ray.t_max = start + kMaxWallShare * size[axis];
  }
  std::vector<float> depths = depths_of_wall(world, std::move(rays));
  for (float& depth : depths) depth -= start;
  constexpr auto kEnough =
      static_cast<std::size_t>(kMinWalledShare * kRaysAlongEdge * kRaysAlongEdge);
  if (depths.size() < kEnough) return 0.0f;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return std::max(*middle, 0.0f);
}

}  // namespace

Bounds open_bounds(const World& world) {
  const Bounds bounds = world_bounds(world.scene());
  if (bounds.empty()) return bounds;
  Bounds open = bounds;
  for (int axis = 0; axis < 3; ++axis) {
    if (bounds.max[axis] <= bounds.min[axis]) continue;
    open.min[axis] += wall_thickness(world, bounds, axis, false);
    open.max[axis] -= wall_thickness(world, bounds, axis, true);
  }
  return open;
}

}  // namespace lambent
