// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, sec. 3.7.2.2 "Morph Targets" and 3.7.3 "Skins".
#include "scene/animation/deform.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "scene/animation/pose.h"
#include "scene/limits.h"
#include "scene/mesh_repair.h"

namespace lambent {
namespace {

// Vertices per task, which then takes some tens of microseconds.
constexpr std::size_t kVerticesATask = 4096;

/// The transform of a vertex: the mean of its joints', by weight.
glm::mat4 mean_transform(const RigMesh& rig, std::size_t vertex,
                         std::span<const glm::mat4> world_from_bind) {
  glm::mat4 mean(0.0f);
  float sum = 0.0f;
  const std::size_t first = vertex * static_cast<std::size_t>(rig.influences);
  for (std::size_t i = first; i < first + static_cast<std::size_t>(rig.influences); ++i) {
    if (rig.weights[i] == 0.0f) continue;
    mean += rig.weights[i] * world_from_bind[rig.joints[i]];
    sum += rig.weights[i];
  }
  // Vertices without weights follow the first joint: they would collapse to the origin otherwise
  return sum > 0.0f ? mean / sum : world_from_bind[0];
}

template <class Vector>
void displace(const std::vector<glm::vec3>& offsets, float weight, std::size_t vertex,
              Vector& value) {
  if (offsets.empty()) return;
  for (int k = 0; k < 3; ++k) value[k] += weight * offsets[vertex][k];
}

/// Deforms the vertices from `begin` to `end` into `bent`, whose attributes have the right lengths.
void bend_vertices(const RigMesh& rig, std::span<const float> morph_weights,
                   std::span<const glm::mat4> world_from_bind, std::size_t begin, std::size_t end,
                   Mesh& bent) {
  const std::size_t targets = std::min(morph_weights.size(), rig.targets.size());
  for (std::size_t v = begin; v < end; ++v) {
    glm::vec3 position = rig.positions[v];
    glm::vec3 normal = rig.normals.empty() ? glm::vec3(0.0f) : rig.normals[v];
    glm::vec4 tangent = rig.tangents.empty() ? glm::vec4(0.0f) : rig.tangents[v];
    for (std::size_t t = 0; t < targets; ++t) {
      if (morph_weights[t] == 0.0f) continue;
      displace(rig.targets[t].positions, morph_weights[t], v, position);
      displace(rig.targets[t].normals, morph_weights[t], v, normal);
      displace(rig.targets[t].tangents, morph_weights[t], v, tangent);
    }
    if (!world_from_bind.empty()) {
      const glm::mat4 world_from_vertex = mean_transform(rig, v, world_from_bind);
      const glm::mat3 linear(world_from_vertex);
      position = glm::vec3(world_from_vertex * glm::vec4(position, 1.0f));
      normal = normal_matrix(linear) * normal;
      tangent = glm::vec4(linear * glm::vec3(tangent), tangent.w);
    }
    bent.positions[v] = position;
    if (!rig.normals.empty()) bent.normals[v] = normal;
    if (!rig.tangents.empty()) bent.tangents[v] = tangent;
  }
}

/// Whether all instances of a deformed mesh are within the range of coordinates.
bool stays_in_reach(const Scene& scene, const Mesh& bent, std::span<const int> instances) {
  const auto near = [](const glm::vec3& p) { return is_in_reach(p); };
  if (!std::all_of(bent.positions.begin(), bent.positions.end(), near)) return false;
  const Bounds bounds = mesh_bounds(bent);
  return std::all_of(instances.begin(), instances.end(), [&](int i) {
    return stays_in_reach(scene.instances[i].world_from_object, bounds);
  });
}

/// Scales normals to unit length; those without direction get their value from `before`.
void repair_bent_normals(const std::vector<glm::vec3>& before, Mesh& bent) {
  for (std::size_t v = 0; v < bent.normals.size(); ++v) {
    // Shorter or longer vectors cannot be scaled to unit length in float arithmetic
    const float squared = glm::dot(bent.normals[v], bent.normals[v]);
    const bool has_direction = squared > FLT_MIN && std::isfinite(squared);
    bent.normals[v] = has_direction ? bent.normals[v] / std::sqrt(squared) : before[v];
  }
}

/// Sets the geometric normals of triangles; no triangles share vertices.
void flatten_normals(Mesh& bent) {
  for (const glm::uvec3& t : bent.triangles) {
    const glm::vec3 normal = glm::cross(bent.positions[t.y] - bent.positions[t.x],
                                        bent.positions[t.z] - bent.positions[t.x]);
    for (int k = 0; k < 3; ++k) bent.normals[t[k]] = normal;
  }
}

/// Recomputes tangents that were not in the file. If this would need vertices that the mesh did not
/// have at rest, the old tangents stay.
void remake_tangents(int uv_set, Mesh& bent) {
  if (bent.uvs[uv_set].empty()) return;
  Mesh remade = bent;
  make_tangents(remade, uv_set);
  if (remade.positions.size() == bent.positions.size()) bent.tangents = std::move(remade.tangents);
}

}  // namespace

glm::mat3 normal_matrix(const glm::mat3& m) {
  const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0f ? -cofactors : cofactors;
}

void deform_mesh(Scene& scene, const RigMesh& rig, std::span<const float> morph_weights,
                 std::span<const glm::mat4> world_from_bind, std::span<const int> instances) {
  Mesh& mesh = scene.meshes[rig.mesh];
  if (mesh.positions.size() != rig.positions.size()) return;
  Mesh bent = mesh;
  parallel_chunks(rig.positions.size(), kVerticesATask, [&](std::size_t begin, std::size_t end) {
    bend_vertices(rig, morph_weights, world_from_bind, begin, end, bent);
  });
  // Skip a pose that leaves the range of coordinates
  if (!stays_in_reach(scene, bent, instances)) return;

  if (rig.normals.empty()) flatten_normals(bent);
  repair_bent_normals(mesh.normals, bent);
  if (!rig.tangents.empty()) {
    repair_tangents(bent);
  } else if (!mesh.tangents.empty()) {
    remake_tangents(scene.materials[mesh.material].normal_texture.uv_set, bent);
  }
  if (bent.positions == mesh.positions && bent.normals == mesh.normals &&
      bent.tangents == mesh.tangents) {
    return;
  }
  ++bent.revision;
  mesh = std::move(bent);
}

}  // namespace lambent
