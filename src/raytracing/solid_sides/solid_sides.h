// SPDX-License-Identifier: Apache-2.0
// Which sides of triangles bound solid matter. A ray that hits such a side comes from inside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lambent/scene.h"
#include "raytracing/raytracer.h"
#include "raytracing/solid_sides/solid_sides_math.h"

namespace lambent {

/// A regular grid of places at which visibility is sampled.
struct PlaceGrid {
  glm::vec3 origin_ws{0.0f};  ///< Its first corner [m].
  glm::mat3 axes{1.0f};       ///< Columns: the grid's axes in world space, unit and orthogonal.
  glm::vec3 spacing{1.0f};    ///< Size of a cell along each axis [m], > 0.
  glm::ivec3 count{2};        ///< Number of places along each axis, >= 2. Cost is in proportion.

  /// A point in cells from the first corner, along the grid's axes.
  glm::vec3 cells_at(const glm::vec3& point_ws) const {
    return ((point_ws - origin_ws) * axes) / spacing;
  }
  /// The coordinates of a place, by its index: along x first, then y.
  glm::ivec3 coords(std::size_t place) const {
    const int i = static_cast<int>(place);
    return {i % count.x, i / count.x % count.y, i / (count.x * count.y)};
  }
  /// Where the place with these coordinates is [m]: off the grid's own planes, within its hull.
  glm::vec3 position_ws(const glm::ivec3& coords) const;
  /// The index of the place with these coordinates.
  std::size_t index(const glm::ivec3& coords) const {
    return (static_cast<std::size_t>(coords.z) * count.y + coords.y) * count.x + coords.x;
  }
  /// Whether a point is within the grid's hull or less than a cell beyond it.
  bool contains(const glm::vec3& point_ws) const;
  bool operator==(const PlaceGrid&) const = default;
  /// The places around a point, or those nearest to it where it is outside.
  std::array<std::size_t, 8> places_around(const glm::vec3& point_ws) const;
};

/// A grid of places, and which of them are open.
struct OpenPlaces {
  PlaceGrid grid;
  std::vector<std::uint8_t> open;  ///< 1: light can arrive there. Along x first, then y.

  /// Whether the place in the cell that begins at a point, or nearest to it, is open.
  bool is_open(const glm::vec3& corner_ws) const;
};

/// For each triangle of each instance, which of its sides bound solid matter: neither, as for
/// leaves, curtains and all that is open on both sides; the back; or the front, where a mesh has
/// the opposite winding.
struct SolidSides {
  std::vector<std::uint32_t> first_word;  ///< For each instance, the index of its first word.
  std::vector<std::uint32_t> words;       ///< See solid_sides_math.h.
  std::vector<OpenPlaces> open_space;     ///< The places from which it was determined.

  /// Whether the side that a ray hit bounds solid matter; false for misses.
  bool is_solid(const Hit& hit) const {
    if (hit.missed()) return false;
    const std::uint32_t word = words[first_word[hit.instance] + solid_sides_word(hit.triangle)];
    return bounds_solid(word, hit.triangle, hit.front_face ? 1u : 0u) != 0u;
  }
  void set(std::uint32_t instance, std::uint32_t triangle, std::uint32_t sides) {
    words[first_word[instance] + solid_sides_word(triangle)] |= sides
                                                                << solid_sides_shift(triangle);
  }
  /// Whether it was made for the scene's present instances and triangles.
  bool fits(const Scene& scene) const;
};

/// A mesh whose winding makes triangles face solid matter.
struct MiswoundMesh {
  int mesh = 0;               ///< Index into Scene::meshes.
  std::size_t triangles = 0;  ///< Number of such triangles, in the instance that has most.
};

/// The single-sided meshes whose winding contradicts, in whole or in part, which sides open space
/// sees. Nothing in this library depends on it; other programs may cull such triangles.
std::vector<MiswoundMesh> miswound_meshes(const Scene& scene, const SolidSides& sides);

/// Solid sides of a scene in which no side bounds solid matter.
SolidSides no_solid_sides(const Scene& scene);

/// Trusts the winding of the meshes: backs of single-sided surfaces bound solid matter.
SolidSides solid_sides_by_winding(const Scene& scene);

}  // namespace lambent
