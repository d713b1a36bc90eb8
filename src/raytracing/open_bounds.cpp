// SPDX-License-Identifier: Apache-2.0
// Where a scene's open space ends: its bounds without the walls around it.
#include <algorithm>
#include <optional>
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

/// How deep below the start of a ray the solid matter that it meets first ends, if it does.
std::optional<float> depth_of_wall(const World& world, Ray ray, float deepest) {
  ray.t_max = deepest;
  for (int i = 0; i < kMaxSurfaces; ++i) {
    const Hit hit = world.tracer().closest_hit(ray);
    if (hit.missed()) return std::nullopt;
    // The far side of a wall, or a single sheet that faces inwards, is met from behind
    if (!hit.front_face) return hit.distance;
    const Scene& scene = world.scene();
    const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
    if (scene.materials[mesh.material].double_sided) return hit.distance;
    ray.t_min = hit.distance * (1.0f + kPastSurface);
  }
  return std::nullopt;
}

/// How far the open space keeps from a side of the bounds.
float wall_thickness(const World& world, const Bounds& bounds, int axis, bool upper) {
  const glm::vec3 size = bounds.max - bounds.min;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const float start = kStartShare * size[axis];
  Ray ray;
  ray.direction = glm::vec3(0.0f);
  ray.direction[axis] = upper ? -1.0f : 1.0f;

  std::vector<float> depths;
  for (int i = 0; i < kRaysAlongEdge * kRaysAlongEdge; ++i) {
    ray.origin[axis] = upper ? bounds.max[axis] + start : bounds.min[axis] - start;
    ray.origin[u] =
        bounds.min[u] + size[u] * (static_cast<float>(i % kRaysAlongEdge) + 0.5f) / kRaysAlongEdge;
    ray.origin[v] =
        bounds.min[v] + size[v] * (static_cast<float>(i / kRaysAlongEdge) + 0.5f) / kRaysAlongEdge;
    const auto depth = depth_of_wall(world, ray, start + kMaxWallShare * size[axis]);
    if (depth) depths.push_back(*depth - start);
  }
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
