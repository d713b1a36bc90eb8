// SPDX-License-Identifier: Apache-2.0
// Bounds of a scene's open space: its bounds without the walls around it and without strays.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "first_picture/subject.h"
#include "lambent/world.h"
#include "raytracing/boxes.h"
#include "raytracing/raytracer.h"
#include "raytracing/solid_sides/find_solid_sides.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

// Number of rays along each edge of a side of the bounds.
constexpr int kRaysAlongEdge = 24;
// Thicker walls than this share of the scene are not walls, but the scene's subject.
constexpr float kMaxWallShare = 0.1f;
// A side is walled where at least this share of its rays pass through a wall.
constexpr float kMinWalledShare = 0.5f;
// Distance from the scene at which rays start, as a share of the scene's size.
constexpr float kStartShare = 0.01f;
// Share of the distance to a hit by which a ray restarts behind the surface.
constexpr float kPastSurface = 1e-5f;
// A side of an object has surfaces that face out of the bounds where at least the first share of
// its rays hits one, no deeper than the second share of the scene's longest side. Probes must be in
// front of these, too: air as deep as kAirShare of that side is added, about a cell of a field of
// 16 probes along it.
constexpr float kMinFacingShare = 0.02f, kMaxFacingDepth = 0.04f;
constexpr float kAirShare = 0.08f;
// Most surfaces that a ray may pass before it is given up.
constexpr int kMaxSurfaces = 16;

/// Depth below the starts of rays at which the first solid matter on each ray ends, for those rays
/// where it does. All rays advance together, surface by surface.
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
      // Rays hit the far side of a wall, or a single sheet around a room, from inside solid matter.
      // A sheet that is open on both sides is a wall around a room, and the skin of an object
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

/// Rays onto a side of the bounds from outside, and the distance from it at which they start.
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

/// Distance from a side of the bounds to the open space inside. Negative where the open space
/// extends beyond the bounds, which it does in front of surfaces that face a viewer outside.
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
  const Subject subject = viewer_ws ? find_subject_near(world, *viewer_ws) : find_subject(world);
  const Bounds bounds = subject.site;
  if (bounds.empty()) return bounds;
  const bool room = is_room(world, subject);
  const SolidSides sides = find_solid_sides(world, {});
  const glm::vec3 viewer = viewer_ws.value_or(0.5f * (bounds.min + bounds.max));
  const bool within = viewer_ws && contains(bounds, viewer);
  Bounds open = bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const float lower = side_inset(world, sides, room, bounds, axis, false,
                                   /*viewed=*/viewer[axis] < bounds.min[axis]);
    const float upper = side_inset(world, sides, room, bounds, axis, true,
                                   /*viewed=*/viewer[axis] > bounds.max[axis]);
    // A wall is between the viewer and the bounds. What would leave the viewer outside is no wall,
    // such as a ground that something far below it brings within the depth of walls
    if (!within || open.min[axis] + lower <= viewer[axis]) open.min[axis] += lower;
    if (!within || open.max[axis] - upper >= viewer[axis]) open.max[axis] -= upper;
  }
  return open;
}

}  // namespace lambent
