// SPDX-License-Identifier: Apache-2.0
#include "compose/history/moved_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "scene/light_tree/light_tree.h"
#include "shared/constants.h"

namespace lambent {
namespace {

// Most frames over which light is averaged while things move. Their shadows may change bounced
// light far from them: a third of the old light is left after as many frames.
constexpr float kMaxFrames = 8.0f;
// With more moving parts than this, light is taken to change everywhere: each costs time at every
// pixel.
constexpr std::size_t kMaxParts = 32;
// A GGX lobe reflects 70 % of its light within this many times its width of the mirror direction
// [rad]: half vectors within half of that angle. The rest comes from so wide an angle that one part
// changes little of it.
constexpr float kLobeReach = 3.0f;

// Surfaces of a part lie on the faces of its box, to within rounding: the box is enlarged by this
// share of its diagonal, as the box around a sheet has no thickness.
constexpr float kBoxMargin = 1e-3f;

/// Angular radius of a sphere at a distance from its centre; pi from inside [rad].
float angular_radius(float radius, float distance) {
  return radius < distance ? std::asin(radius / distance) : kPi;
}

/// Angle between two directions of any length [rad].
float angle_between(const vec3& a, const vec3& b) {
  const float scale = std::sqrt(dot(a, a) * dot(b, b));
  return scale > 0.0f ? std::acos(std::clamp(dot(a, b) / scale, -1.0f, 1.0f)) : 0.0f;
}

}  // namespace

MovedParts::MovedParts(std::span<const Bounds> moved, std::span<const Bounds> emitters)
    : boxes_(moved.begin(), moved.end()), moved_(around(moved)), emitters_(around(emitters)) {}

std::vector<MovedParts::BoundingSphere> MovedParts::around(std::span<const Bounds> boxes) {
  std::vector<BoundingSphere> spheres;
  for (const Bounds& box : boxes) {
    if (!box.empty()) {
      spheres.push_back({0.5f * box.min + 0.5f * box.max, 0.5f * length(box.max - box.min)});
    }
  }
  return spheres;
}

bool MovedParts::contain(const vec3& position_ws) const {
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const Bounds& box) {
    if (box.empty()) return false;
    const vec3 margin(kBoxMargin * length(box.max - box.min));
    return glm::all(glm::greaterThanEqual(position_ws, box.min - margin)) &&
           glm::all(glm::lessThanEqual(position_ws, box.max + margin));
  });
}

float MovedParts::frames_around(const vec3& position_ws, const vec3& normal_ws) const {
  // Old light may be wrong by about the share of the light's directions that the parts fill
  float share = 0.0f;
  for (const BoundingSphere& part : moved_) {
    const vec3 way = part.center_ws - position_ws;
    // What is below the horizon sends no light
    if (dot(way, normal_ws) < -part.radius) continue;
    const float squared_radius = part.radius * part.radius;
    share += squared_radius /
             std::max({dot(way, way), squared_radius, std::numeric_limits<float>::min()});
  }
  return 1.0f / std::clamp(share, 1.0f / kMaxFrames, 1.0f);
}

bool MovedParts::may_shade(const BoundingSphere& part, const vec3& position_ws) const {
  const vec3 to_part = part.center_ws - position_ws;
  const float part_distance = length(to_part);
  const float part_angle = angular_radius(part.radius, part_distance);
  return std::any_of(emitters_.begin(), emitters_.end(), [&](const BoundingSphere& lights) {
    const vec3 to_lights = lights.center_ws - position_ws;
    const float distance = length(to_lights);
    if (part_distance - part.radius > distance + lights.radius) return false;
    return angle_between(to_part, to_lights) <=
           part_angle + angular_radius(lights.radius, distance);
  });
}

float MovedParts::frames_of_surface(const vec3& position_ws, const vec3& normal_ws) const {
  const bool shaded = std::any_of(moved_.begin(), moved_.end(), [&](const BoundingSphere& part) {
    return dot(part.center_ws - position_ws, normal_ws) >= -part.radius &&
           may_shade(part, position_ws);
  });
  return shaded ? 1.0f : frames_around(position_ws, normal_ws);
}

float MovedParts::frames_of_lobe(const vec3& position_ws, const LobeGuide& lobe) const {
  const float reach = kLobeReach * inversesqrt(lobe.sharpness);
  const float distance =
      lobe.inverse_distance > 0.0f ? 1.0f / lobe.inverse_distance : kInfiniteDistance;
  for (const BoundingSphere& part : moved_) {
    const vec3 way = part.center_ws - position_ws;
    const float part_distance = length(way);
    if (part_distance - part.radius > distance) continue;
    if (angle_between(way, lobe.mirror_ws) <= reach + angular_radius(part.radius, part_distance)) {
      return 1.0f;
    }
  }
  if (distance == kInfiniteDistance) return kMaxFrames;
  return frames_of_surface(position_ws + distance * lobe.mirror_ws, vec3(0.0f));
}

std::optional<MovedParts> moved_since(const World& world, std::uint64_t revision) {
  const auto edits = world.changes_since(revision);
  if (!edits || std::ranges::any_of(*edits, &WorldChanges::relights)) return std::nullopt;
  std::vector<Bounds> moved;
  for (const WorldChanges& edit : *edits) {
    moved.insert(moved.end(), edit.moved.begin(), edit.moved.end());
  }
  if (moved.size() > kMaxParts) return std::nullopt;
  std::vector<Bounds> emitters;
  const std::vector<LightTreeNode>& groups = lights_of(world).groups().nodes();
  for (std::size_t i = 0; i < std::min<std::size_t>(groups.size(), kLightGroupSize); ++i) {
    if (groups[i].intensity <= 0.0f) continue;
    emitters.push_back(
        {groups[i].center_ws - groups[i].half_size, groups[i].center_ws + groups[i].half_size});
  }
  return MovedParts(moved, emitters);
}

}  // namespace lambent
