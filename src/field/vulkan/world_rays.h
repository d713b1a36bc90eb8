// SPDX-License-Identifier: Apache-2.0
// Rays of a field's probes through our own world on a device, and what they meet, shaded.
#pragma once

#include <span>
#include <vector>

#include "field/vulkan/passes_vulkan.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/vulkan/hit_shading.h"

namespace lambent {

/// Memory of a batch's rays, which one batch uses after the other.
struct WorldRayBuffers {
  vulkan::Buffer rays, hits, points, shaded, direct, first_indices;
};

class WorldRaysVulkan final : public RaySourceVulkan {
 public:
  /// Makes room for the rays of a list's probes. `cells` are those whose probes `visibility` looks
  /// across. `sees`: whether `shade` leaves the distances that rays saw. All that is given outlives
  /// the commands that are recorded.
  WorldRaysVulkan(FieldResources& field, HitShading& shading, WorldRayBuffers& buffers,
                  const DeviceWorld& world, const DeviceProbes& list, std::span<const int> cells,
                  bool sees);

  int batches() const override { return static_cast<int>(batches_.size()); }
  void schedule(vulkan::Recorder&) override {}  // the host has chosen the probes
  void trace(vulkan::Recorder& to, int batch) override;
  void shade(vulkan::Recorder& to, int batch) override;
  void visibility(vulkan::Recorder& to) override;
  const DeviceTracer* tracer() const override { return &world_.tracer(); }
  void placement(vulkan::Recorder&) override {}  // the host has placed the probes

  /// Records that the rays which shading and lookups trace are counted; after all passes.
  void record_counts(vulkan::Recorder& to) const;
  /// Rays of probes, and of all else once what was recorded has run.
  std::uint64_t probe_rays() const;
  std::uint64_t other_rays() const;

 private:
  FieldResources& field_;
  HitShading& shading_;
  WorldRayBuffers& buffers_;
  const DeviceWorld& world_;
  const DeviceProbes& list_;
  bool sees_;
  std::vector<DeviceGroup> batches_;
  int cell_count_;
  vulkan::Buffer cells_, shadow_rays_, lookup_rays_;
};

}  // namespace lambent
