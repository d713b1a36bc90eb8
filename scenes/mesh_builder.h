// SPDX-License-Identifier: Apache-2.0
// Triangles from a few kinds of surface. All functions guarantee the following: front faces run
// counter-clockwise, texture coordinates are metres (u to the right and v down as seen from the
// front, so that nothing is mirrored), and neighbouring pieces have bit-identical positions along
// shared edges.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "lambent/scene.h"

namespace lambent::scenes {

class MeshBuilder {
 public:
  /// Sets the transform of everything that is added from now on.
  void set_transform(const glm::mat4& transform);

  /// A flat quadrilateral: lower left, lower right, upper right, upper left as seen from the front.
  /// Texture coordinates are the position's projections on the plane's axes, so that patterns
  /// continue across pieces.
  void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

  /// A flat quadrilateral whose texture coordinate u grows along `right` (unit) instead of along
  /// the lower edge.
  void quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d,
            const glm::vec3& right);

  /// Which faces of a box are made.
  enum Faces : unsigned {
    kLeft = 1,    // -X
    kRight = 2,   // +X
    kBottom = 4,  // -Y
    kTop = 8,     // +Y
    kBack = 16,   // -Z
    kFront = 32,  // +Z
    kAllFaces = 63,
  };
  /// An axis-aligned box seen from outside.
  void box(const glm::vec3& min, const glm::vec3& max, unsigned faces = kAllFaces);
  /// A box seen from inside: a room.
  void room(const glm::vec3& min, const glm::vec3& max);

  /// A point of a surface and its texture coordinates [m].
  struct SurfacePoint {
    glm::vec3 position;
    glm::vec2 uv;
  };
  /// A smooth surface: `at(s, t)` over the unit square, s to the right and t upwards as seen from
  /// the front. `closed` joins s = 1 to s = 0.
  void surface(int columns, int rows, bool closed,
               const std::function<SurfacePoint(float s, float t)>& at);

  /// Corners of a lathe's profile above this angle are sharp edges [rad].
  static constexpr float kCreaseAngle = 0.6f;
  /// A body of revolution about the vertical through `foot`. `profile` lists (radius, height), with
  /// the body to the left of the path (upwards on the outside). Corners sharper than kCreaseAngle
  /// remain sharp.
  void lathe(const glm::vec3& foot, std::span<const glm::vec2> profile, int segments);

  /// A wall with an arched opening, in the plane z = 0: from x = -half_width to half_width, from
  /// `spring` up to `top`; the opening is half an ellipse. Ends and top are omitted, since
  /// neighbours and slabs cover them.
  struct Arch {
    float half_width, spring, top;  // [m]
    float half_span, rise;          // of the opening [m]
    float thickness;                // along z, half on each side [m]
    int segments;
    bool soles;  // close the undersides of the springers
  };
  void arch_panel(const Arch& arch);

  /// A raised band around that opening on the wall's +Z face: `width` along the wall, and
  /// protruding by `depth`.
  void archivolt(const Arch& arch, float width, float depth);

  /// A moulding: `profile` lists (outwards, up) from the lower to the upper edge of its face,
  /// `path` runs on a level with the outside to its right, mitred at its corners; heights add to
  /// the path's.
  void moulding(std::span<const glm::vec2> profile, std::span<const glm::vec3> path, bool closed);

  /// A round bar between two points, without end caps.
  void bar(const glm::vec3& from, const glm::vec3& to, float radius, int segments);

  /// A sphere of flat facets, two poles and `rings` bands.
  void faceted_sphere(const glm::vec3& centre, float radius, int segments, int rings);

  std::size_t triangles() const { return mesh_.triangles.size(); }

  /// Returns the mesh so far, and clears the builder. Texture coordinates are divided by
  /// `metres_a_tile`.
  Mesh take(std::string name, int material, float metres_a_tile = 1.0f);

 private:
  std::uint32_t vertex(const glm::vec3& position, const glm::vec3& normal, const glm::vec2& uv);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void facet(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

  Mesh mesh_;
  glm::mat4 transform_{1.0f};
  glm::mat3 normal_transform_{1.0f};
};

}  // namespace lambent::scenes
