// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scene/animation/pose.h"
#include "shared/rays.h"

namespace lambent::gltf {
namespace {

// Coordinates may be this many times as large as the scene. Rays then start less than a thousandth
// of its size off its surfaces, since offset_ray_component moves by 256 units in the last place.
constexpr double kFarSizes = 32.0;

// Relative precision of coordinates, which have 24 bits: smaller boxes cannot be distinguished from
// a point.
constexpr double kRounding = 1e-7;

// Rays may start at most this share of a scene's longest side off its surfaces, less than the
// thickness of walls.
constexpr float kMaxRayOffset = 1e-2f;

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

// The longest side of a box, and its largest coordinate [m].
double extent_of(const Bounds& bounds) {
  return largest(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
}
double reach_of(const Bounds& bounds) {
  return largest(glm::max(glm::abs(glm::dvec3(bounds.min)), glm::abs(glm::dvec3(bounds.max))));
}

std::string metres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", length);
  return text;
}

}  // namespace

glm::dvec3 origin_of(const Bounds& bounds) {
  if (bounds.empty()) return glm::dvec3(0.0);
  const double extent = extent_of(bounds), reach = reach_of(bounds);
  if (reach <= kFarSizes * extent) return glm::dvec3(0.0);
  // A power of ten not above the size, so that the origin is in the box or close to it
  const double step = std::pow(10.0, std::floor(std::log10(std::max(extent, kRounding * reach))));
  const glm::dvec3 middle = 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
  // Use the inverse of a step below 1, since only whole powers of ten are exact
  const glm::dvec3 origin =
      step >= 1.0 ? glm::round(middle / step) * step
                  : glm::round(middle * std::round(1.0 / step)) / std::round(1.0 / step);
  return origin + glm::dvec3(0.0);  // replaces -0 by 0, since it is printed
}

bool is_rounded(const Scene& scene) {
  const Bounds world = world_bounds(scene);
  if (world.empty()) return false;
  if (origin_of(world) != glm::dvec3(0.0)) return true;
  std::vector<double> reaches;
  for (const Mesh& mesh : scene.meshes) {
    reaches.push_back(mesh.positions.empty() ? 0.0 : reach_of(mesh_bounds(mesh)));
  }
  const double farthest = kFarSizes * extent_of(world);
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& placed) {
    return reaches[placed.mesh] * largest_scale(placed.world_from_object) > farthest;
  });
}

std::string warning_of_move(const Bounds& bounds, const glm::dvec3& origin) {
  if (origin == glm::dvec3(0.0)) return {};
  char place[128];
  std::snprintf(place, sizeof place, "(%.10g, %.10g, %.10g) m", origin.x, origin.y, origin.z);
  return "The scene is " + metres(extent_of(bounds)) + " large, " + metres(glm::length(origin)) +
         " from its file's origin, where coordinates are coarse. It was moved: all places, those "
         "of options too, are the file's less " +
         place + ".";
}

std::string warning_of_size(const Bounds& bounds) {
  if (bounds.empty()) return {};
  const auto reach = static_cast<float>(reach_of(bounds));
  const auto extent = static_cast<float>(extent_of(bounds));
  const float offset = offset_ray_component(reach, 1.0f) - reach;
  if (offset <= kMaxRayOffset * extent) return {};
  return "The scene is " + metres(extent) + " large, and rays start " + metres(offset) +
         " off its surfaces: light is wrong. Scale it up.";
}

}  // namespace lambent::gltf
