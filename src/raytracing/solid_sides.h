// SPDX-License-Identifier: Apache-2.0
// Which sides of triangles bound solid matter. A ray that meets such a side comes from inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lambent/scene.h"
#include "raytracing/raytracer.h"
#include "raytracing/solid_sides_math.h"

namespace lambent {

/// For each triangle of each instance, which of its sides bound solid matter: neither, as with
/// leaves, curtains and all that is open on both sides, the back, or the front where a mesh is
/// wound the other way round.
struct SolidSides {
  std::vector<std::uint32_t> first_word;  ///< For each instance, the index of its first word.
  std::vector<std::uint32_t> words;       ///< See solid_sides_math.h.

  /// Whether the side that a ray met bounds solid matter. A ray that met nothing meets none.
  bool is_solid(const Hit& hit) const {
    if (hit.missed()) return false;
    const std::uint32_t word = words[first_word[hit.instance] + solid_sides_word(hit.triangle)];
    return bounds_solid(word, hit.triangle, hit.front_face ? 1u : 0u) != 0u;
  }
  void set(std::uint32_t instance, std::uint32_t triangle, std::uint32_t sides) {
    words[first_word[instance] + solid_sides_word(triangle)] |= sides
                                                                << solid_sides_shift(triangle);
  }
  /// Whether it was made for the scene's instances and triangles as they are now.
  bool fits(const Scene& scene) const;
};

/// A mesh of which triangles face solid matter, as their vertices run.
struct MiswoundMesh {
  int mesh = 0;               ///< Index into Scene::meshes.
  std::size_t triangles = 0;  ///< So many of them do, in the instance where most do.
};

/// The meshes that are wound, in whole or in part, against what open space sees of them. Nothing
/// depends on it here; other programs may leave such triangles out.
std::vector<MiswoundMesh> miswound_meshes(const Scene& scene, const SolidSides& sides);

/// Sides that all bound nothing.
SolidSides no_solid_sides(const Scene& scene);

/// Takes the word of whoever made the meshes: backs of single-sided surfaces bound solid matter.
SolidSides solid_sides_by_winding(const Scene& scene);

}  // namespace lambent
