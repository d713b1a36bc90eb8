// SPDX-License-Identifier: Apache-2.0
#include "raytracing/solid_sides/solid_sides.h"

#include <algorithm>

namespace lambent {
namespace {

// Offset of places from the grid, into its hull [places]: scenes and grids are made in round
// numbers, and a place in a wall's own plane would be on either side of it by chance.
const glm::vec3 kOffPlanes(0.437f, 0.511f, 0.473f);

std::size_t triangles_of(const Scene& scene, const Instance& instance) {
  return scene.meshes[instance.mesh].triangles.size();
}

std::size_t words_of(const Scene& scene, const Instance& instance) {
  return (triangles_of(scene, instance) + kSidesPerWord - 1) / kSidesPerWord;
}

}  // namespace

glm::vec3 PlaceGrid::position_ws(const glm::ivec3& coords) const {
  const glm::vec3 cells =
      (glm::vec3(coords) + kOffPlanes) * glm::vec3(count - 1) / glm::vec3(count);
  return origin_ws + axes * (spacing * cells);
}

std::array<std::size_t, 8> PlaceGrid::places_around(const glm::vec3& point_ws) const {
  const glm::ivec3 base =
      glm::clamp(glm::ivec3(glm::floor(cells_at(point_ws))), glm::ivec3(0), count - 2);
  std::array<std::size_t, 8> places{};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 at = base + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    places[corner] = index(at);
  }
  return places;
}

bool PlaceGrid::contains(const glm::vec3& point_ws) const {
  const glm::vec3 cells = cells_at(point_ws);
  return glm::all(glm::greaterThanEqual(cells, glm::vec3(-1.0f))) &&
         glm::all(glm::lessThanEqual(cells, glm::vec3(count)));
}

bool OpenPlaces::is_open(const glm::vec3& corner_ws) const {
  const glm::ivec3 coords(glm::round(grid.cells_at(corner_ws)));
  return open[grid.index(glm::clamp(coords, glm::ivec3(0), grid.count - 1))] != 0;
}

bool SolidSides::fits(const Scene& scene) const {
  if (first_word.size() != scene.instances.size()) return false;
  std::size_t word = 0;
  for (std::size_t i = 0; i < first_word.size(); ++i) {
    if (first_word[i] != word) return false;
    word += words_of(scene, scene.instances[i]);
  }
  return words.size() == word;
}

std::vector<MiswoundMesh> miswound_meshes(const Scene& scene, const SolidSides& sides) {
  std::vector<std::size_t> miswound(scene.meshes.size(), 0);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const int mesh = scene.instances[i].mesh;
    if (scene.materials[scene.meshes[mesh].material].double_sided) continue;
    std::size_t count = 0;
    for (std::uint32_t t = 0; t < scene.meshes[mesh].triangles.size(); ++t) {
      const std::uint32_t word = sides.words[sides.first_word[i] + solid_sides_word(t)];
      count += bounds_solid(word, t, 1u);
    }
    miswound[mesh] = std::max(miswound[mesh], count);
  }
  std::vector<MiswoundMesh> meshes;
  for (std::size_t m = 0; m < miswound.size(); ++m) {
    if (miswound[m] > 0) meshes.push_back({static_cast<int>(m), miswound[m]});
  }
  return meshes;
}

SolidSides no_solid_sides(const Scene& scene) {
  SolidSides sides;
  std::size_t word = 0;
  for (const Instance& instance : scene.instances) {
    sides.first_word.push_back(static_cast<std::uint32_t>(word));
    word += words_of(scene, instance);
  }
  sides.words.assign(word, 0u);
  return sides;
}

SolidSides solid_sides_by_winding(const Scene& scene) {
  SolidSides sides = no_solid_sides(scene);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    if (scene.materials[mesh.material].double_sided) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) sides.set(i, t, kSolidBack);
  }
  return sides;
}

}  // namespace lambent
