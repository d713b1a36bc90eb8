// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_repair.h"

#include <algorithm>
#include <cassert>
#include <cfloat>
#include <cmath>

#include "shared/sampling.h"

namespace lambent {
namespace {

glm::dvec3 doubled_area_vector(const Mesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3 a(mesh.positions[triangle.x]);
  const glm::dvec3 b(mesh.positions[triangle.y]);
  const glm::dvec3 c(mesh.positions[triangle.z]);
  return glm::cross(b - a, c - a);
}

glm::vec3 geometric_normal(const Mesh& mesh, const glm::uvec3& triangle) {
  return glm::vec3(glm::normalize(doubled_area_vector(mesh, triangle)));
}

// Appends a copy of a vertex and returns its index.
std::uint32_t duplicate_vertex(Mesh& mesh, std::uint32_t vertex, VertexOrigins* origins) {
  const auto copy = [vertex](auto& attribute) {
    if (attribute.empty()) return;
    const auto value = attribute[vertex];
    attribute.push_back(value);
  };
  copy(mesh.positions);
  copy(mesh.normals);
  copy(mesh.tangents);
  copy(mesh.uvs[0]);
  copy(mesh.uvs[1]);
  copy(mesh.colors);
  if (origins != nullptr) copy(*origins);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

template <class T>
void gather(std::vector<T>& attribute, const std::vector<std::uint32_t>& vertices) {
  if (attribute.empty()) return;
  std::vector<T> gathered(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) gathered[i] = attribute[vertices[i]];
  attribute = std::move(gathered);
}

// Shorter vectors cannot be scaled to unit length in float arithmetic.
bool has_direction(const glm::vec3& v) {
  const float squared = glm::dot(v, v);
  return squared > FLT_MIN && std::isfinite(squared);
}

// Direction in which the first texture coordinate grows over a triangle, and whether the
// coordinates are mirrored there.
struct UvFrame {
  glm::dvec3 tangent{0.0};
  bool mirrored = false;
  bool defined = false;
};

UvFrame uv_frame(const Mesh& mesh, const glm::uvec3& t, int uv_set) {
  const auto& uvs = mesh.uvs[uv_set];
  const glm::dvec3 e1 = glm::dvec3(mesh.positions[t.y]) - glm::dvec3(mesh.positions[t.x]);
  const glm::dvec3 e2 = glm::dvec3(mesh.positions[t.z]) - glm::dvec3(mesh.positions[t.x]);
  const glm::dvec2 d1 = glm::dvec2(uvs[t.y]) - glm::dvec2(uvs[t.x]);
  const glm::dvec2 d2 = glm::dvec2(uvs[t.z]) - glm::dvec2(uvs[t.x]);
  const double area = d1.x * d2.y - d1.y * d2.x;
  UvFrame frame;
  // Since v points down, a positive area means a mirrored image
  frame.mirrored = area > 0.0;
  const glm::dvec3 tangent = (e1 * d2.y - e2 * d1.y) * (area < 0.0 ? -1.0 : 1.0);
  const double length = glm::length(tangent);
  if (area == 0.0 || !(length > 0.0) || !std::isfinite(length)) return frame;
  frame.tangent = tangent / length;
  frame.defined = true;
  return frame;
}

double corner_angle(const Mesh& mesh, const glm::uvec3& t, int corner) {
  const glm::dvec3 p(mesh.positions[t[corner]]);
  const glm::dvec3 a = glm::dvec3(mesh.positions[t[(corner + 1) % 3]]) - p;
  const glm::dvec3 b = glm::dvec3(mesh.positions[t[(corner + 2) % 3]]) - p;
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Duplicates vertices that triangles with mirrored coordinates share with unmirrored ones.
void split_mirrored_vertices(Mesh& mesh, const std::vector<UvFrame>& frames,
                             VertexOrigins* origins) {
  constexpr std::uint32_t kNone = ~0u;
  const std::size_t vertices = mesh.positions.size();
  std::vector<bool> used_unmirrored(vertices, false);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!frames[i].defined || frames[i].mirrored) continue;
    for (int k = 0; k < 3; ++k) used_unmirrored[mesh.triangles[i][k]] = true;
  }
  std::vector<std::uint32_t> mirrored_copy(vertices, kNone);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!frames[i].defined || !frames[i].mirrored) continue;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& vertex = mesh.triangles[i][k];
      if (!used_unmirrored[vertex]) continue;
      std::uint32_t& copy = mirrored_copy[vertex];
      if (copy == kNone) copy = duplicate_vertex(mesh, vertex, origins);
      vertex = copy;
    }
  }
}

}  // namespace

DroppedTriangles drop_degenerate_triangles(Mesh& mesh) {
  DroppedTriangles dropped;
  // The sine of pi is not quite 0: corners at the pole of a sphere are as far apart as it rounds to
  constexpr double kSamePlace = 1e-6;  // distance, as a share of the longest edge
  const auto is_sliver = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const auto [least, most] =
        std::minmax({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    return least > kSamePlace * most;
  };
  // Computed in float, as in the passes, which cannot compute a normal where this underflows
  const auto is_degenerate = [&](const glm::uvec3& triangle) {
    const glm::vec3 a = mesh.positions[triangle.x], b = mesh.positions[triangle.y],
                    c = mesh.positions[triangle.z];
    const bool degenerate = !has_direction(glm::cross(b - a, c - a));
    if (degenerate && is_sliver(a, b, c)) ++dropped.slivers;
    return degenerate;
  };
  dropped.all = std::erase_if(mesh.triangles, is_degenerate);
  return dropped;
}

void drop_unused_vertices(Mesh& mesh, VertexOrigins* origins) {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> new_index(mesh.positions.size(), kUnused);
  std::size_t used = 0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& index = new_index[triangle[k]];
      if (index != kUnused) continue;
      index = 0;
      ++used;
    }
  }
  if (used == mesh.positions.size()) return;

  std::vector<std::uint32_t> kept;
  kept.reserve(used);
  for (std::uint32_t vertex = 0; vertex < new_index.size(); ++vertex) {
    if (new_index[vertex] == kUnused) continue;
    new_index[vertex] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(vertex);
  }
  gather(mesh.positions, kept);
  gather(mesh.normals, kept);
  gather(mesh.tangents, kept);
  gather(mesh.uvs[0], kept);
  gather(mesh.uvs[1], kept);
  gather(mesh.colors, kept);
  if (origins != nullptr) gather(*origins, kept);
  for (glm::uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) triangle[k] = new_index[triangle[k]];
  }
}

void make_flat_normals(Mesh& mesh, VertexOrigins* origins) {
  std::vector<std::uint32_t> vertices;
  vertices.reserve(mesh.triangles.size() * 3);
  std::vector<glm::vec3> normals;
  normals.reserve(mesh.triangles.size() * 3);
  for (glm::uvec3& triangle : mesh.triangles) {
    const glm::vec3 normal = geometric_normal(mesh, triangle);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (int k = 0; k < 3; ++k) {
      vertices.push_back(triangle[k]);
      normals.push_back(normal);
    }
    triangle = glm::uvec3(first, first + 1, first + 2);
  }
  gather(mesh.positions, vertices);
  gather(mesh.tangents, vertices);
  gather(mesh.uvs[0], vertices);
  gather(mesh.uvs[1], vertices);
  gather(mesh.colors, vertices);
  if (origins != nullptr) gather(*origins, vertices);
  mesh.normals = std::move(normals);
}

std::size_t repair_normals(Mesh& mesh) {
  std::vector<bool> broken(mesh.normals.size(), false);
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    glm::vec3& normal = mesh.normals[i];
    if (has_direction(normal)) {
      normal = glm::normalize(normal);
    } else {
      broken[i] = true;
      normal = glm::vec3(0.0f, 1.0f, 0.0f);
      ++count;
    }
  }
  if (count == 0) return 0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (broken[triangle[k]]) mesh.normals[triangle[k]] = geometric_normal(mesh, triangle);
    }
  }
  return count;
}

std::size_t repair_tangents(Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    glm::vec4& tangent = mesh.tangents[i];
    glm::vec3 direction(tangent);
    if (has_direction(direction)) {
      direction = glm::normalize(direction);
    } else {
      direction = make_frame(mesh.normals[i]).tangent;
      ++count;
    }
    tangent = glm::vec4(direction, tangent.w < 0.0f ? -1.0f : 1.0f);
  }
  return count;
}

void make_tangents(Mesh& mesh, int uv_set, VertexOrigins* origins) {
  assert(mesh.uvs[uv_set].size() == mesh.positions.size());
  mesh.tangents.clear();
  std::vector<UvFrame> frames(mesh.triangles.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i] = uv_frame(mesh, mesh.triangles[i], uv_set);
  }
  split_mirrored_vertices(mesh, frames, origins);

  // Sum the triangles' tangents at each vertex, projected to its tangent plane, weighted by the
  // angle there
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  mesh.tangents.assign(mesh.positions.size(), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].defined) continue;
    const glm::uvec3& triangle = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 normal(mesh.normals[triangle[k]]);
      const glm::dvec3 flat = frames[i].tangent - normal * glm::dot(normal, frames[i].tangent);
      const double length = glm::length(flat);
      if (length > 0.0) sums[triangle[k]] += flat / length * corner_angle(mesh, triangle, k);
      if (frames[i].mirrored) mesh.tangents[triangle[k]].w = -1.0f;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    mesh.tangents[i] = glm::vec4(glm::vec3(sums[i]), mesh.tangents[i].w);
  }
  repair_tangents(mesh);
}

}  // namespace lambent
