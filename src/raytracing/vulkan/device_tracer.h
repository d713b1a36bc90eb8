// SPDX-License-Identifier: Apache-2.0
// The interface of ray tracers on a device: our own acceleration structures, or an engine's.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "raytracing/ray_records.h"

namespace lambent {

namespace vulkan {
class Buffer;
class Recorder;
}  // namespace vulkan

/// Rays in a device's memory.
struct RayBatch {
  RayArray rays;            ///< Rays with mask 0 are not traced.
  std::uint32_t count = 0;  ///< Number of rays, where the host knows it; 0: nothing is recorded.
  /// Where only the device knows the number: a buffer for indirect use that holds a
  /// VkTraceRaysIndirectCommandKHR (width, height 1, depth 1) at this offset; `count` is then an
  /// upper bound.
  const vulkan::Buffer* indirect = nullptr;
  std::size_t indirect_offset = 0;
};

/// Finds the hits of rays on a device. Alpha and transmission stop the same rays as in RayTracer.
/// Queries are recorded: barriers before (for rays) and after (for results) are the caller's.
/// Queries leave the scene's textures bound (Recorder::bind_textures).
class DeviceTracer {
 public:
  virtual ~DeviceTracer() = default;

  /// Records the search for the nearest hit of each ray. `hits`: one HitRecord a ray; rays that are
  /// not traced miss.
  virtual void closest_hits(vulkan::Recorder& recorder, const RayBatch& batch,
                            HitArray hits) const = 0;

  /// Records the search for an opaque surface between t_min and t_max. `occluded`: one word a ray,
  /// 1 where there is one, else 0; 0 for rays that are not traced.
  virtual void occlusions(vulkan::Recorder& recorder, const RayBatch& batch,
                          UintArray occluded) const = 0;

  /// See RayTracer::has_glass.
  virtual bool has_glass() const { return false; }

  /// See RayTracer::dims_shadows.
  virtual bool dims_shadows() const { return false; }

  /// Records RayTracer::transmittances; only for tracers that dims_shadows(). `hits`: rays end just
  /// before these; address 0: at their own ends. `through`: one share a ray, 1 for rays that are
  /// not traced.
  virtual void transmittances(vulkan::Recorder& /*recorder*/, const RayBatch& /*batch*/,
                              HitArray /*hits*/, Vec3Array /*through*/) const {
    assert(!dims_shadows());
  }
};

}  // namespace lambent
