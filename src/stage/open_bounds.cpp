// SPDX-License-Identifier: Apache-2.0
// Where a scene's open space ends: its bounds without the walls around it.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "lambent/world.h"
#include "raytracing/find_solid_sides.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "stage/survey.h"

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
// A side of an object has surfaces that face out of the bounds where this share of its rays
// meets one no deeper than this share of the scene. Probes must stand in front of these, too: air
// as deep as this share of the scene's longest side is added, about a cell of a field of 16 probes
// along it.
constexpr float kMinFacingShare = 0.02f, kMaxFacingDepth = 0.04f;
constexpr float kAirShare = 0.08f;
// Surfaces that a ray may pass before it counts as lost in a thicket.
constexpr int kMaxSurfaces = 16;

/// How deep below the starts of rays the solid matter that each meets first ends, of those where it
/// does. Rays go on through surfaces together.
std::vector<float> depths_of_wall(const World& world, const SolidSides& sides, bool room,
                                  std::vector<Ray> rays) {
  std::vector<float> depths;
  std::vector<Hit> hits;
  for (int i = 0; i < kMaxSurfaces && !rays.empty(); ++i) {
    hits.assign(rays.size(), {});
    tracer_of(world).closest_hits(rays, hits);
    std::size_t left = 0;
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const Hit& hit = hits[r];
      if (hit.missed()) continue;
      // The far side of a wall, or a single sheet around a room, is met from inside solid matter;
      // around a room a sheet that is open on both sides is a wall, and around an object its skin
      Hit other_side = hit;
      other_side.front_face = !hit.front_face;
      if (sides.is_solid(hit) || (room && !sides.is_solid(other_side))) {
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

/// Rays that look at a side of the bounds from outside, and how far outside they start.
struct SideRays {
  std::vector<Ray> rays;
  float start = 0.0f;
};

SideRays rays_at_side(const Bounds& bounds, int axis, bool upper) {
  const glm::vec3 size = bounds.max - bounds.min;
  const float longest = std::max({size.x, size.y, size.z});
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const float start = kStartShare * (size[axis] > 0.0f ? size[axis] : longest);
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
    ray.t_max = start + (size[axis] > 0.0f ? kMaxWallShare * size[axis] : start);
  }
  return {std::move(rays), start};
}

/// Whether surfaces near a side of the bounds face out of it.
bool faces_out(const World& world, const SideRays& side, float longest) {
  std::vector<Hit> hits(side.rays.size());
  tracer_of(world).closest_hits(side.rays, hits);
  const float deepest = side.start + kMaxFacingDepth * longest;
  const auto facing =
      std::count_if(hits.begin(), hits.end(), [&](const Hit& h) { return h.distance <= deepest; });
  return static_cast<float>(facing) >= kMinFacingShare * static_cast<float>(hits.size());
}

/// How far the open space keeps from a side of the bounds; negative: it reaches out of them, which
/// it does in front of what faces a viewer outside.
float side_inset(const World& world, const SolidSides& sides, bool room, const Bounds& bounds,
                 int axis, bool upper, bool viewed) {
  const glm::vec3 size = bounds.max - bounds.min;
  const float longest = std::max({size.x, size.y, size.z});
  const SideRays side = rays_at_side(bounds, axis, upper);
  if (viewed && faces_out(world, side, longest)) return -kAirShare * longest;
  std::vector<float> depths = depths_of_wall(world, sides, room, side.rays);
  for (float& depth : depths) depth -= side.start;
  constexpr auto kEnough =
      static_cast<std::size_t>(kMinWalledShare * kRaysAlongEdge * kRaysAlongEdge);
  if (depths.size() < kEnough) {
    return !room && faces_out(world, side, longest) ? -kAirShare * longest : 0.0f;
  }
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return std::max(*middle, 0.0f);
}

}  // namespace

Bounds open_bounds(const World& world, std::optional<glm::vec3> viewer_ws) {
  const Bounds bounds = world_bounds(world.scene());
  if (bounds.empty()) return bounds;
  const bool room = is_room(world, find_subject(world));
  const SolidSides sides = find_solid_sides(world, {});
  const glm::vec3 viewer = viewer_ws.value_or(0.5f * (bounds.min + bounds.max));
  Bounds open = bounds;
  for (int axis = 0; axis < 3; ++axis) {
    open.min[axis] += side_inset(world, sides, room, bounds, axis, false,
                                 /*viewed=*/viewer[axis] < bounds.min[axis]);
    open.max[axis] -= side_inset(world, sides, room, bounds, axis, true,
                                 /*viewed=*/viewer[axis] > bounds.max[axis]);
  }
  return open;
}

}  // namespace lambent
