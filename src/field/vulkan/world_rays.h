// SPDX-License-Identifier: Apache-2.0
// The rays of a field's probes in our own world on a device, their hits and their shading.
#pragma once

#include <span>
#include <vector>

#include "field/correction/device_training.h"
#include "field/vulkan/passes_vulkan.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/vulkan/hit_shading.h"

namespace lambent {

/// Memory for the rays of one batch at a time.
struct WorldRayBuffers {
  vulkan::Buffer rays, hits, points, shaded, direct, first_indices;
  vulkan::Buffer solid_first_words, solid_words;  ///< ProbeData::solid_sides.
};

class WorldRaysVulkan final : public RaySourceVulkan {
 public:
  /// Reserves memory for the rays of a list's probes. `cells` are the cells that `visibility` works
  /// on. With `sees`, shade() also records the distances that rays count as. `training` is that on
  /// which DeviceTraining::begin() was called for the update; null: the update learns no
  /// corrections. All arguments must outlive the execution of the recorded commands.
  WorldRaysVulkan(FieldResources& field, HitShading& shading, WorldRayBuffers& buffers,
                  const DeviceWorld& world, const DeviceProbes& list, std::span<const int> cells,
                  bool sees, DeviceTraining* training);

  int batches() const override { return static_cast<int>(batches_.size()); }
  void scroll(vulkan::Recorder&) override {}    // the host has scrolled the volumes
  void schedule(vulkan::Recorder&) override {}  // the host has chosen the probes
  void trace(vulkan::Recorder& to, int batch) override;
  void shade(vulkan::Recorder& to, int batch) override;
  void visibility(vulkan::Recorder& to) override;
  bool learns() const override { return training_ != nullptr; }
  void corrections(vulkan::Recorder& to) override { training_->record(to, world_); }
  const DeviceTracer* tracer() const override { return &world_.tracer(); }
  void placement(vulkan::Recorder&) override {}  // the host has placed the probes

  /// Records the counting of shadow and visibility rays. It must be called after all passes.
  void record_counts(vulkan::Recorder& to) const;
  /// The number of probe rays.
  std::uint64_t probe_rays() const;
  /// The number of shadow and visibility rays, once the recorded commands have run.
  std::uint64_t other_rays() const;

 private:
  FieldResources& field_;
  HitShading& shading_;
  WorldRayBuffers& buffers_;
  const DeviceWorld& world_;
  const DeviceProbes& list_;
  bool sees_;
  DeviceTraining* training_;
  std::vector<DeviceGroup> batches_;
  int cell_count_;
  vulkan::Buffer cells_, shadow_rays_, lookup_rays_;
};

}  // namespace lambent
