// SPDX-License-Identifier: Apache-2.0
// Embree's handles, and the conversion of meshes and instances to its geometry.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "lambent/scene.h"
#include "raytracing/embree/api.h"
#include "raytracing/raytracer.h"
#include "scene/coverage.h"

namespace lambent::embree {

template <class T, void (*release)(T)>
struct Releaser {
  using pointer = T;
  void operator()(T handle) const { release(handle); }
};
using Device = std::unique_ptr<RTCDevice, Releaser<RTCDevice, rtcReleaseDevice>>;
using SceneHandle = std::unique_ptr<RTCScene, Releaser<RTCScene, rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometry, Releaser<RTCGeometry, rtcReleaseGeometry>>;

/// Embree's id of the one instance that holds all static geometry.
inline constexpr unsigned kStillId = 0;
/// Embree's ids of instances: slots plus one. Unlike indices into the scene's list, they outlive
/// edits.
inline unsigned id_of_slot(std::uint32_t slot) {
  return slot + 1;
}

/// The purpose of a ray, which the filter of transparent surfaces reads.
struct Query : Context {
  enum class Kind : std::uint8_t { closest, occlusion, transmittance };
  Query(Kind asked, const Ray& traced, float passed_before = kNothingPassed)
      : kind(asked), ray(traced), passed(passed_before) {
    start(*this);
  }

  Kind kind;
  const Ray& ray;
  float passed;  // blended surfaces up to this distance let the ray through [m]
  // For transmittance: the product of shares so far, and the sum of absorption times distance
  glm::vec3 through{1.0f};
  glm::vec3 optical_depth{0.0f};
};

/// The scene's instance in each slot, for hits and for the filter of transparent surfaces.
struct Slots {
  const Scene* scene = nullptr;
  std::vector<std::uint32_t> instance_of;  ///< Index of the instance, by slot.

  /// The slot that a hit belongs to. Sets `baked` to whether its vertices are in world space.
  static std::uint32_t slot_of(unsigned geometry_id, unsigned instance_id, bool& baked) {
    baked = instance_id == RTC_INVALID_GEOMETRY_ID || instance_id == kStillId;
    return (baked ? geometry_id : instance_id) - 1;
  }
};

/// A mesh as triangles, in world space where `world_from_object` is not null. `slots` must outlive
/// it. Returns null where memory runs out.
Geometry make_mesh(RTCDevice device, const Mesh& mesh, const Slots& slots,
                   const glm::mat4* world_from_object);

/// Whether the geometry of a mesh still has its triangles, given that their number is the same.
bool has_triangles_of(RTCGeometry geometry, const Mesh& mesh);

/// Copies moved vertices into the geometry of their mesh; the caller commits its scene.
void move_vertices(RTCGeometry geometry, const Mesh& mesh);

/// An instance of a scene that holds one mesh.
Geometry make_instance(RTCDevice device, RTCScene mesh, const glm::mat4& world_from_object,
                       std::uint32_t mask);

}  // namespace lambent::embree
