// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_builder.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "shared/constants.h"
#include "shared/sampling.h"

namespace lambent::scenes {
namespace {

/// Triangles with less area than this are degenerate corners of grids [m^2].
constexpr float kNoArea = 1e-10f;

/// Tangents along the direction in which u grows, from all triangles around a vertex. Textures are
/// never mirrored here, so the bitangent's sign is +1 (u right, v down: cross(normal, tangent)
/// points up the image).
std::vector<glm::vec4> tangents_of(const Mesh& mesh) {
  std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0.0f));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 e1 = mesh.positions[t.y] - mesh.positions[t.x];
    const glm::vec3 e2 = mesh.positions[t.z] - mesh.positions[t.x];
    const glm::vec2 d1 = mesh.uvs[0][t.y] - mesh.uvs[0][t.x];
    const glm::vec2 d2 = mesh.uvs[0][t.z] - mesh.uvs[0][t.x];
    const float determinant = d1.x * d2.y - d2.x * d1.y;
    if (determinant == 0.0f) continue;
    const glm::vec3 along_u = (e1 * d2.y - e2 * d1.y) / determinant;
    const float area = glm::length(glm::cross(e1, e2));
    for (int k = 0; k < 3; ++k) sums[t[k]] += glm::normalize(along_u) * area;
  }
  std::vector<glm::vec4> tangents;
  tangents.reserve(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::vec3 n = mesh.normals[i];
    const glm::vec3 flat = sums[i] - n * glm::dot(n, sums[i]);
    const float size = glm::length(flat);
    const glm::vec3 tangent = size > 0.0f ? flat / size : make_frame(n).tangent;
    tangents.emplace_back(tangent, 1.0f);
  }
  return tangents;
}

}  // namespace

void MeshBuilder::set_transform(const glm::mat4& transform) {
  transform_ = transform;
  normal_transform_ = glm::transpose(glm::inverse(glm::mat3(transform)));
}

std::uint32_t MeshBuilder::vertex(const glm::vec3& position, const glm::vec3& normal,
                                  const glm::vec2& uv) {
  mesh_.positions.push_back(glm::vec3(transform_ * glm::vec4(position, 1.0f)));
  mesh_.normals.push_back(glm::normalize(normal_transform_ * normal));
  mesh_.uvs[0].push_back(uv);
  return static_cast<std::uint32_t>(mesh_.positions.size()) - 1;
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto& p = mesh_.positions;
  if (0.5f * glm::length(glm::cross(p[b] - p[a], p[c] - p[a])) <= kNoArea) return;
  mesh_.triangles.emplace_back(a, b, c);
}

void MeshBuilder::facet(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
  const glm::vec3 right = glm::normalize(b - a);
  const glm::vec3 up = glm::cross(n, right);
  const auto uv = [&](const glm::vec3& p) {
    return glm::vec2(glm::dot(p, right), -glm::dot(p, up));
  };
  const std::uint32_t ia = vertex(a, n, uv(a));
  const std::uint32_t ib = vertex(b, n, uv(b));
  const std::uint32_t ic = vertex(c, n, uv(c));
  triangle(ia, ib, ic);
}

void MeshBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                       const glm::vec3& d) {
  quad(a, b, c, d, glm::normalize(b - a));
}

void MeshBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                       const glm::vec3& d, const glm::vec3& right) {
  const glm::vec3 n = glm::normalize(glm::cross(c - a, d - b));
  const glm::vec3 up = glm::cross(n, right);
  const auto uv = [&](const glm::vec3& p) {
    return glm::vec2(glm::dot(p, right), -glm::dot(p, up));
  };
  const std::uint32_t ia = vertex(a, n, uv(a));
  const std::uint32_t ib = vertex(b, n, uv(b));
  const std::uint32_t ic = vertex(c, n, uv(c));
  const std::uint32_t id = vertex(d, n, uv(d));
  triangle(ia, ib, ic);
  triangle(ia, ic, id);
}

void MeshBuilder::box(const glm::vec3& lo, const glm::vec3& hi, unsigned faces) {
  if (faces & kFront) quad({lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, hi, {lo.x, hi.y, hi.z});
  if (faces & kBack) quad({hi.x, lo.y, lo.z}, lo, {lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z});
  if (faces & kLeft) quad(lo, {lo.x, lo.y, hi.z}, {lo.x, hi.y, hi.z}, {lo.x, hi.y, lo.z});
  if (faces & kRight) quad({hi.x, lo.y, hi.z}, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, hi);
  if (faces & kTop) quad({lo.x, hi.y, hi.z}, hi, {hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z});
  if (faces & kBottom) quad(lo, {hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {lo.x, lo.y, hi.z});
}

void MeshBuilder::room(const glm::vec3& lo, const glm::vec3& hi) {
  quad({hi.x, lo.y, hi.z}, {lo.x, lo.y, hi.z}, {lo.x, hi.y, hi.z}, hi);
  quad(lo, {hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z});
  quad({lo.x, lo.y, hi.z}, lo, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z});
  quad({hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, hi, {hi.x, hi.y, lo.z});
  quad({lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}, hi, {lo.x, hi.y, hi.z});
  quad({lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, lo.y, lo.z}, lo);
}

void MeshBuilder::surface(int columns, int rows, bool closed,
                          const std::function<SurfacePoint(float s, float t)>& at) {
  const int stride = columns + 1;
  std::vector<SurfacePoint> points;
  points.reserve(static_cast<std::size_t>(stride) * (rows + 1));
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      points.push_back(at(static_cast<float>(i) / columns, static_cast<float>(j) / rows));
    }
    if (closed) points.back().position = points[points.size() - stride].position;
  }

  // Sum the cells' unit normals around every vertex, so that narrow cells of a sharp fold count as
  // much as wide ones; the seam of a closed surface belongs to both of its ends.
  std::vector<glm::vec3> normals(points.size(), glm::vec3(0.0f));
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * stride + i, b = a + 1, c = b + stride, d = a + stride;
      const glm::vec3 n = glm::cross(points[c].position - points[a].position,
                                     points[d].position - points[b].position);
      const float size = glm::length(n);
      if (size == 0.0f) continue;
      for (int k : {a, b, c, d}) normals[k] += n / size;
    }
  }
  for (int j = 0; closed && j <= rows; ++j) {
    const int first = j * stride, last = first + columns;
    normals[first] = normals[last] = normals[first] + normals[last];
  }

  const auto base = static_cast<std::uint32_t>(mesh_.positions.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    vertex(points[i].position, normals[i], points[i].uv);
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = base + j * stride + i, b = a + 1, c = b + stride, d = a + stride;
      triangle(a, b, c);
      triangle(a, c, d);
    }
  }
}

void MeshBuilder::lathe(const glm::vec3& foot, std::span<const glm::vec2> profile, int segments) {
  assert(profile.size() >= 2);
  // Cut the profile at its sharp corners; each run is a smooth surface.
  std::size_t begin = 0;
  float height = 0.0f;
  while (begin + 1 < profile.size()) {
    std::size_t end = begin + 1;
    while (end + 1 < profile.size()) {
      const glm::vec2 before = glm::normalize(profile[end] - profile[end - 1]);
      const glm::vec2 after = glm::normalize(profile[end + 1] - profile[end]);
      if (glm::dot(before, after) < std::cos(kCreaseAngle)) break;
      ++end;
    }
    std::vector<float> lengths{height};
    float widest = 0.0f;
    for (std::size_t i = begin; i <= end; ++i) {
      widest = glm::max(widest, profile[i].x);
      if (i > begin) lengths.push_back(lengths.back() + glm::distance(profile[i], profile[i - 1]));
    }
    const int rows = static_cast<int>(end - begin);
    surface(segments, rows, true, [&](float s, float t) {
      const auto row = static_cast<std::size_t>(std::lround(t * rows));
      const glm::vec2 point = profile[begin + row];
      const float angle = -kTwoPi * s;
      return SurfacePoint{
          foot + glm::vec3(point.x * std::cos(angle), point.y, point.x * std::sin(angle)),
          glm::vec2(s * kTwoPi * widest, -lengths[row])};
    });
    height = lengths.back();
    begin = end;
  }
}

void MeshBuilder::faceted_sphere(const glm::vec3& centre, float radius, int segments, int rings) {
  const auto point = [&](int i, int j) {
    const float longitude = -kTwoPi * static_cast<float>(i % segments) / segments;
    const float latitude = kPi * (static_cast<float>(j) / rings - 0.5f);
    const float r = j == 0 || j == rings ? 0.0f : std::cos(latitude);
    return centre +
           radius * glm::vec3(r * std::cos(longitude), std::sin(latitude), r * std::sin(longitude));
  };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < segments; ++i) {
      const glm::vec3 a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1),
                      d = point(i, j + 1);
      if (j > 0) facet(a, b, c);
      if (j + 1 < rings) facet(a, c, d);
    }
  }
}

Mesh MeshBuilder::take(std::string name, int material, float metres_a_tile) {
  for (glm::vec2& uv : mesh_.uvs[0]) uv /= metres_a_tile;
  mesh_.tangents = tangents_of(mesh_);
  mesh_.name = std::move(name);
  mesh_.material = material;
  return std::exchange(mesh_, Mesh{});
}

}  // namespace lambent::scenes
