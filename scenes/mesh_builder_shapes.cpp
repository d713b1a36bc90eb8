// SPDX-License-Identifier: Apache-2.0
// The builder's architectural shapes: arches, mouldings, bars.
#include <cmath>

#include "scenes/mesh_builder.h"
#include "shared/constants.h"
#include "shared/sampling.h"

namespace lambent::scenes {
namespace {

constexpr glm::vec3 kAlongX{1.0f, 0.0f, 0.0f};

/// The point on the opening's edge at a share of the angle from the left springer to the right one.
glm::vec3 on_arch(const MeshBuilder::Arch& arch, float share, float z, float grown = 0.0f) {
  const float angle = kPi * share;
  return {-(arch.half_span + grown) * std::cos(angle),
          arch.spring + (arch.rise + grown) * std::sin(angle), z};
}

/// Length of the opening's edge, for texture coordinates: Ramanujan's first approximation, halved.
float arc_length(const MeshBuilder::Arch& arch) {
  const float a = arch.half_span, b = arch.rise;
  return 0.5f * kPi * (3.0f * (a + b) - std::sqrt((3.0f * a + b) * (a + 3.0f * b)));
}

}  // namespace

void MeshBuilder::arch_panel(const Arch& arch) {
  const float z = 0.5f * arch.thickness;
  const auto wall = [&](const glm::vec3& low_left, const glm::vec3& low_right) {
    // The piece of wall above an edge, from the front and from the back
    const auto back = [](glm::vec3 p) { return glm::vec3(p.x, p.y, -p.z); };
    const glm::vec3 a = low_left, b = low_right;
    const glm::vec3 c(b.x, arch.top, b.z), d(a.x, arch.top, a.z);
    quad(a, b, c, d, kAlongX);
    quad(back(b), back(a), back(d), back(c), -kAlongX);
  };
  wall({-arch.half_width, arch.spring, z}, {-arch.half_span, arch.spring, z});
  for (int i = 0; i < arch.segments; ++i) {
    const float n = static_cast<float>(arch.segments);
    glm::vec3 from = on_arch(arch, i / n, z), to = on_arch(arch, (i + 1) / n, z);
    if (i == 0) from = {-arch.half_span, arch.spring, z};
    if (i + 1 == arch.segments) to = {arch.half_span, arch.spring, z};
    wall(from, to);
  }
  wall({arch.half_span, arch.spring, z}, {arch.half_width, arch.spring, z});

  const float length = arc_length(arch);
  surface(1, arch.segments, false, [&](float s, float t) {
    return SurfacePoint{on_arch(arch, t, z - s * arch.thickness),
                        {s * arch.thickness, -t * length}};
  });
  if (!arch.soles) return;
  for (const float side : {-1.0f, 1.0f}) {
    const float x0 = side < 0.0f ? -arch.half_width : arch.half_span;
    const float x1 = side < 0.0f ? -arch.half_span : arch.half_width;
    quad({x0, arch.spring, -z}, {x1, arch.spring, -z}, {x1, arch.spring, z}, {x0, arch.spring, z});
  }
}

void MeshBuilder::archivolt(const Arch& arch, float width, float depth) {
  const float back = 0.5f * arch.thickness, front = back + depth;
  const float length = arc_length(arch);
  surface(arch.segments, 1, false, [&](float s, float t) {
    return SurfacePoint{on_arch(arch, s, front, t * width), {s * length, -t * width}};
  });
  surface(arch.segments, 1, false, [&](float s, float t) {
    return SurfacePoint{on_arch(arch, s, glm::mix(front, back, t), width),
                        {s * length, -t * depth}};
  });
  surface(arch.segments, 1, false, [&](float s, float t) {
    return SurfacePoint{on_arch(arch, s, glm::mix(back, front, t)), {s * length, -t * depth}};
  });
  for (const float x0 : {-arch.half_span - width, arch.half_span}) {
    const float x1 = x0 + width, y = arch.spring;
    quad({x0, y, back}, {x1, y, back}, {x1, y, front}, {x0, y, front});
  }
}

void MeshBuilder::moulding(std::span<const glm::vec2> profile, std::span<const glm::vec3> path,
                           bool closed) {
  const auto count = static_cast<int>(path.size());
  const auto outwards = [&](int from) {
    const glm::vec3 way = path[(from + 1) % count] - path[from];
    return glm::cross(glm::normalize(way), glm::vec3(0.0f, 1.0f, 0.0f));
  };
  const auto corner = [&](int i, const glm::vec2& p) {
    const bool first = !closed && i == 0, last = !closed && i == count - 1;
    const glm::vec3 before = outwards(first ? 0 : (i + count - 1) % count);
    const glm::vec3 after = outwards(last ? count - 2 : i);
    const glm::vec3 mitre = (before + after) / (1.0f + glm::dot(before, after));
    return path[i] + mitre * p.x + glm::vec3(0.0f, p.y, 0.0f);
  };
  for (int i = 0; i < (closed ? count : count - 1); ++i) {
    const int next = (i + 1) % count;
    const glm::vec3 right = glm::normalize(path[next] - path[i]);
    for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
      quad(corner(i, profile[k]), corner(next, profile[k]), corner(next, profile[k + 1]),
           corner(i, profile[k + 1]), right);
    }
  }
}

void MeshBuilder::bar(const glm::vec3& from, const glm::vec3& to, float radius, int segments) {
  const float length = glm::distance(from, to);
  const Frame frame = make_frame((to - from) / length);
  surface(segments, 1, true, [&](float s, float t) {
    const float angle = kTwoPi * s;
    const glm::vec3 around = frame.tangent * std::cos(angle) + frame.bitangent * std::sin(angle);
    return SurfacePoint{glm::mix(from, to, t) + radius * around,
                        {s * kTwoPi * radius, -t * length}};
  });
}

}  // namespace lambent::scenes
