// SPDX-License-Identifier: Apache-2.0
#include "compose/history/moved_parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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
// With more boxes of moving parts than this, two for each one, light is taken to change everywhere:
// each costs time at every pixel.
constexpr std::size_t kMaxBoxes = 64;
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

std::vector<Bounds> without_empty(std::span<const Bounds> boxes) {
  std::vector<Bounds> kept;
  std::ranges::copy_if(boxes, std::back_inserter(kept),
                       [](const Bounds& box) { return !box.empty(); });
  return kept;
}

/// Whether any of a box is above the horizon of a surface.
bool reaches_above(const Bounds& box, const vec3& position_ws, const vec3& normal_ws) {
  const vec3 highest(normal_ws.x > 0.0f ? box.max.x : box.min.x,
                     normal_ws.y > 0.0f ? box.max.y : box.min.y,
                     normal_ws.z > 0.0f ? box.max.z : box.min.z);
  return dot(highest - position_ws, normal_ws) >= 0.0f;
}

/// Whether a part's box meets any segment from a point to a box of lights. After a share s of their
/// lengths, the segments' points fill a box p + s (lights - p), each of whose faces is on the right
/// side of the part's opposite face within an interval of s: they meet where the intervals do.
/// Based on: Haines and Wallace, "Shaft Culling for Efficient Ray-Cast Radiosity", EGWR 1991.
bool may_shade(const Bounds& part, const vec3& position_ws, const Bounds& lights) {
  float first = 0.0f, last = 1.0f;
  // Holds the interval to what fulfils distance <= s * slope
  const auto hold = [&](float distance, float slope) {
    if (slope > 0.0f) {
      first = std::max(first, distance / slope);
    } else if (slope < 0.0f) {
      last = std::min(last, distance / slope);
    } else if (distance > 0.0f) {
      last = -1.0f;
    }
  };
  for (int k = 0; k < 3; ++k) {
    hold(part.min[k] - position_ws[k], lights.max[k] - position_ws[k]);
    hold(position_ws[k] - part.max[k], position_ws[k] - lights.min[k]);
  }
  return first <= last;
}

}  // namespace

MovedParts::MovedParts(std::span<const Bounds> moved, std::span<const Bounds> emitters)
    : boxes_(without_empty(moved)), emitters_(without_empty(emitters)) {
  for (Bounds& box : boxes_) {
    const float diagonal = length(box.max - box.min);
    spheres_.push_back({0.5f * box.min + 0.5f * box.max, 0.5f * diagonal});
    box.min -= kBoxMargin * diagonal;
    box.max += kBoxMargin * diagonal;
  }
}

bool MovedParts::contain(const vec3& position_ws) const {
  return std::any_of(boxes_.begin(), boxes_.end(), [&](const Bounds& box) {
    return glm::all(glm::greaterThanEqual(position_ws, box.min)) &&
           glm::all(glm::lessThanEqual(position_ws, box.max));
  });
}

float MovedParts::frames_of_gathers(const vec3& position_ws, const vec3& normal_ws) const {
  // Old light may be wrong by about the share of the light's directions that the parts fill
  float share = 0.0f;
  for (const BoundingSphere& part : spheres_) {
    const vec3 way = part.center_ws - position_ws;
    // What is below the horizon sends no light
    if (dot(way, normal_ws) < -part.radius) continue;
    const float squared_radius = part.radius * part.radius;
    share += squared_radius /
             std::max({dot(way, way), squared_radius, std::numeric_limits<float>::min()});
  }
  return 1.0f / std::clamp(share, 1.0f / kMaxFrames, 1.0f);
}

float MovedParts::frames_of_emitters(const vec3& position_ws, const vec3& normal_ws) const {
  const bool shaded = std::any_of(emitters_.begin(), emitters_.end(), [&](const Bounds& lights) {
    if (!reaches_above(lights, position_ws, normal_ws)) return false;
    return std::any_of(boxes_.begin(), boxes_.end(), [&](const Bounds& part) {
      return reaches_above(part, position_ws, normal_ws) && may_shade(part, position_ws, lights);
    });
  });
  return shaded ? 1.0f : kInfiniteDistance;
}

float MovedParts::frames_of_lobe(const vec3& position_ws, const LobeGuide& lobe) const {
  const float reach = kLobeReach * inversesqrt(lobe.sharpness);
  const float distance =
      lobe.inverse_distance > 0.0f ? 1.0f / lobe.inverse_distance : kInfiniteDistance;
  for (const BoundingSphere& part : spheres_) {
    const vec3 way = part.center_ws - position_ws;
    const float part_distance = length(way);
    if (part_distance - part.radius > distance) continue;
    if (angle_between(way, lobe.mirror_ws) <= reach + angular_radius(part.radius, part_distance)) {
      return 1.0f;
    }
  }
  if (distance == kInfiniteDistance) return kMaxFrames;
  const vec3 shown_ws = position_ws + distance * lobe.mirror_ws;
  return std::min(frames_of_gathers(shown_ws, vec3(0.0f)),
                  frames_of_emitters(shown_ws, vec3(0.0f)));
}

float ChangedLight::frames_of_emitters(const vec3& position_ws, const vec3& normal_ws) const {
  return emitters ? 1.0f : moved.frames_of_emitters(position_ws, normal_ws);
}

std::optional<ChangedLight> light_changed_since(const World& world, std::uint64_t revision) {
  const auto edits = world.changes_since(revision);
  if (!edits) return std::nullopt;
  std::vector<Bounds> moved;
  bool relit = false, sampled = false;
  for (const WorldChanges& edit : *edits) {
    moved.insert(moved.end(), edit.moved.begin(), edit.moved.end());
    relit = relit || edit.relights();
    // Maps of the sky have a bright part that is sampled, materials may let light through, and of
    // many lights some are sampled
    const bool few = lights_of(world).lights().size() + edit.lights.size() <= kMaxLightsAsked;
    sampled = sampled || edit.emission || edit.environment || !edit.materials.empty() ||
              (!edit.lights.empty() && !few);
  }
  if (moved.size() > kMaxBoxes) return std::nullopt;
  std::vector<Bounds> emitters;
  const std::vector<LightTreeNode>& groups = lights_of(world).groups().nodes();
  for (std::size_t i = 0; i < std::min<std::size_t>(groups.size(), kLightGroupSize); ++i) {
    if (groups[i].intensity <= 0.0f) continue;
    emitters.push_back(
        {groups[i].center_ws - groups[i].half_size, groups[i].center_ws + groups[i].half_size});
  }
  return ChangedLight{MovedParts(moved, emitters), relit, sampled};
}

}  // namespace lambent
