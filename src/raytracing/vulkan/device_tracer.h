// SPDX-License-Identifier: Apache-2.0
// What passes on a device ask of a ray tracer: acceleration structures of ours, or an engine's.
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
  RayArray rays;            ///< RayRecords; rays of mask 0 are not traced.
  std::uint32_t count = 0;  ///< How many, where the host knows; 0: nothing is recorded.
  /// Where the device alone knows how many: a buffer made for indirect use which holds a
  /// VkTraceRaysIndirectCommandKHR (width, height 1, depth 1) at this offset; `count` is then the
  /// most that there can be.
  const vulkan::Buffer* indirect = nullptr;
  std::size_t indirect_offset = 0;
};

/// Finds on a device what rays meet, as RayTracer does on the host: what is see-through stops the
/// same rays. Queries are recorded: barriers before (for rays) and after (for results) are the
/// caller's. The scene's textures are bound afterwards (Recorder::bind_textures).
class DeviceTracer {
 public:
  virtual ~DeviceTracer() = default;

  /// Records the search for the nearest hit of each ray. `hits`: a HitRecord a ray; rays that are
  /// not traced have missed.
  virtual void closest_hits(vulkan::Recorder& recorder, const RayBatch& batch,
                            HitArray hits) const = 0;

  /// Records the search for anything between t_min and t_max. `occluded`: a word a ray, 1 where
  /// there is, else 0, which it is for rays that are not traced, too.
  virtual void occlusions(vulkan::Recorder& recorder, const RayBatch& batch,
                          UintArray occluded) const = 0;

  /// As RayTracer::has_glass.
  virtual bool has_glass() const { return false; }

  /// Records the search for what light passes, as RayTracer::transmittances; of tracers that have
  /// glass. `hits`: rays end just before these; of address 0: at their own ends. `through`: a share
  /// a ray, 1 for rays that are not traced.
  virtual void transmittances(vulkan::Recorder& /*recorder*/, const RayBatch& /*batch*/,
                              HitArray /*hits*/, Vec3Array /*through*/) const {
    assert(!has_glass());
  }
};

}  // namespace lambent
