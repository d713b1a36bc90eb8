// SPDX-License-Identifier: Apache-2.0
// Rays of passes on a device, traced by the host: so that both sides shade the very same hits.
#pragma once

#include <deque>
#include <functional>

#include "raytracing/raytracer.h"
#include "raytracing/vulkan/device_tracer.h"
#include "vulkan/buffer.h"
#include "vulkan/device.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent::test {

/// Passes are recorded and run again and again: each run reads back the rays of one more query,
/// whose answers the next runs put in their place.
class HostTracer final : public DeviceTracer {
 public:
  HostTracer(const vulkan::Device& device, const RayTracer& tracer);

  /// Runs what `record` records until every ray has its answer.
  void run(const std::function<void(vulkan::Recorder&)>& record);

  void closest_hits(vulkan::Recorder& recorder, const RayBatch& batch,
                    HitArray hits) const override;
  void occlusions(vulkan::Recorder& recorder, const RayBatch& batch,
                  UintArray occluded) const override;

 private:
  struct Query {
    std::uint32_t count;
    bool closest;
    bool answered = false;
    vulkan::Buffer rays, answers;
  };
  void next_query(vulkan::Recorder& recorder, const RayBatch& batch, bool closest,
                  std::uint64_t answers) const;
  void copy(vulkan::Recorder& recorder, std::uint64_t from, std::uint64_t to,
            std::size_t bytes) const;
  void answer(Query& query) const;

  const vulkan::Device& device_;
  const RayTracer& tracer_;
  vulkan::Kernel copy_;
  mutable std::deque<Query> queries_;
  mutable std::size_t recorded_ = 0;
};

/// Rays as a device wants them.
inline RayRecord record_of(const Ray& ray) {
  return {ray.origin, ray.t_min, ray.direction, ray.t_max, ray.mask};
}
inline Ray ray_of(const RayRecord& ray) {
  return {ray.origin_ws, ray.t_min, ray.direction_ws, ray.t_max, ray.mask};
}
inline HitRecord record_of(const Hit& hit) {
  return {hit.distance,     hit.instance, hit.triangle, hit.barycentrics, hit.front_face ? 1u : 0u,
          hit.sample_weight};
}

}  // namespace lambent::test
