// SPDX-License-Identifier: Apache-2.0
// Repairs of meshes from files, so that they can be rendered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lambent/scene.h"

namespace lambent {

/// The original index of each vertex, before any repair. Functions that renumber vertices update it
/// if it is given.
using VertexOrigins = std::vector<std::uint32_t>;

/// How many triangles without area a mesh had.
struct DroppedTriangles {
  std::size_t all = 0;
  /// Those of them whose corners are in three places, to within rounding. The others are common, as
  /// at the poles of spheres and in strips, and no sign of a fault.
  std::size_t slivers = 0;
};

/// Drops triangles without area, which have no normal.
DroppedTriangles drop_degenerate_triangles(Mesh& mesh);

/// Drops vertices that no triangle uses: primitives of one file often share a vertex buffer of
/// which each uses a part, and unused vertices would enlarge the bounds.
void drop_unused_vertices(Mesh& mesh, VertexOrigins* origins = nullptr);

/// Gives each triangle vertices of its own with its geometric normal (glTF 2.0, sec. 3.7.2.1).
void make_flat_normals(Mesh& mesh, VertexOrigins* origins = nullptr);

/// Scales normals to unit length; those without direction become the normal of a triangle that uses
/// them. Returns how many had none.
std::size_t repair_normals(Mesh& mesh);

/// Scales tangents to unit length, with w = +1 or -1; those without direction become some vector
/// perpendicular to the normal. Returns how many had none.
std::size_t repair_tangents(Mesh& mesh);

/// Computes tangents from a set of texture coordinates, splitting vertices where the coordinates
/// mirror.
void make_tangents(Mesh& mesh, int uv_set, VertexOrigins* origins = nullptr);

}  // namespace lambent
