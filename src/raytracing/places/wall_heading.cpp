// SPDX-License-Identifier: Apache-2.0
#include "raytracing/places/wall_heading.h"

#include <array>
#include <cmath>

#include "shared/constants.h"

namespace lambent {
namespace {

// Walls are counted by their headings, in steps of one degree of the quarter turn after which a box
// looks the same.
constexpr int kHeadings = 90;
// Surfaces whose normals have a smaller vertical component are walls.
constexpr float kMaxWallTilt = 0.1f;
// The walls of one heading, give or take a degree, are most if they are this share of the area of
// all. Columns and trees face anywhere.
constexpr double kMostWalls = 0.5;

/// The area of walls by heading.
std::array<double, kHeadings> areas_by_heading(const Scene& scene) {
  std::array<double, kHeadings> areas{};
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::mat3 linear(instance.world_from_object);
    for (const glm::uvec3& triangle : mesh.triangles) {
      const glm::vec3 corner = mesh.positions[triangle.x];
      const glm::vec3 normal = glm::cross(linear * (mesh.positions[triangle.y] - corner),
                                          linear * (mesh.positions[triangle.z] - corner));
      const float area = glm::length(normal);
      if (!(area > 0.0f) || std::abs(normal.y) > kMaxWallTilt * area) continue;
      const float turns = std::atan2(normal.x, normal.z) / (0.5f * kPi) + 2.0f;
      const float heading = turns - std::floor(turns);
      areas[static_cast<int>(heading * kHeadings) % kHeadings] += area;
    }
  }
  return areas;
}

}  // namespace

glm::mat3 axes_of_walls(const Scene& scene) {
  const std::array<double, kHeadings> areas = areas_by_heading(scene);
  double all = 0.0, most = 0.0;
  int best = 0;
  for (int i = 0; i < kHeadings; ++i) {
    all += areas[i];
    const double around =
        areas[(i + kHeadings - 1) % kHeadings] + areas[i] + areas[(i + 1) % kHeadings];
    if (around > most) {
      most = around;
      best = i;
    }
  }
  // Within two degrees of the axes, a turned grid would gain nothing
  if (best <= 1 || best >= kHeadings - 2 || most < kMostWalls * all) return glm::mat3(1.0f);
  const float angle = (static_cast<float>(best) + 0.5f) / kHeadings * 0.5f * kPi;
  const float c = std::cos(angle), s = std::sin(angle);
  return {{c, 0.0f, -s}, {0.0f, 1.0f, 0.0f}, {s, 0.0f, c}};
}

Bounds bounds_along(const Scene& scene, const glm::mat3& axes) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    Instance turned;
    turned.mesh = instance.mesh;
    turned.world_from_object = glm::mat4(glm::transpose(axes)) * instance.world_from_object;
    bounds.add(instance_bounds(scene, turned));
  }
  return bounds;
}

}  // namespace lambent
