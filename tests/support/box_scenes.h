// SPDX-License-Identifier: Apache-2.0
// Scenes of boxes, as the tests of where probes stand want them.
#pragma once

#include <utility>
#include <vector>

#include "lambent/scene.h"
#include "support/hand_made.h"

namespace lambent::test {

/// A closed box from `low` to `high` whose triangles face outwards or, as a room's, inwards.
inline Mesh box_mesh(const glm::vec3& low, const glm::vec3& high, bool inwards = false) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                                (i & 4) != 0 ? high.z : low.z);
    mesh.normals.push_back(glm::normalize(mesh.positions.back() - 0.5f * (low + high)));
  }
  // Corners of each side, counter-clockwise as seen from outside
  constexpr glm::uint kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& side : kSides) {
    for (const int k : {1, 2}) {
      const glm::uvec3 outwards(side[0], side[k], side[k + 1]);
      mesh.triangles.push_back(inwards ? glm::uvec3(outwards.x, outwards.z, outwards.y) : outwards);
    }
  }
  return mesh;
}

/// One instance of each mesh, of grey Lambert material.
inline Scene scene_of(std::vector<Mesh> meshes) {
  Scene scene;
  Material grey;
  grey.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  grey.metallic = 0.0f;
  grey.lambert = true;
  scene.materials.push_back(grey);
  for (Mesh& mesh : meshes) {
    Instance instance;
    instance.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
  }
  return scene;
}

/// A sheet of paper 6 m wide, on the ground and up a wall behind it.
inline Mesh sweep_mesh() {
  Mesh sweep = quad({-3, 0, -2}, {6, 0, 0}, {0, 0, 4}, 0);
  sweep.positions.insert(sweep.positions.end(), {{-3, 3, -2}, {3, 3, -2}});
  sweep.normals.resize(6, {0, 0, 1});
  sweep.triangles.insert(sweep.triangles.end(), {{0, 1, 5}, {0, 5, 4}});
  sweep.uvs = {};
  return sweep;
}

}  // namespace lambent::test
