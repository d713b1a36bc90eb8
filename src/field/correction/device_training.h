// SPDX-License-Identifier: Apache-2.0
// Gathers from which a field in a device's memory learns corrections of its lookups: the twin of
// train_corrections().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "field/correction/train_corrections.h"
#include "field/correction/train_math.h"
#include "field/vulkan/field_resources.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/vulkan/hit_shading.h"

namespace lambent {

class DeviceTraining {
 public:
  /// The field must outlive it.
  explicit DeviceTraining(FieldResources& field);

  /// Uploads the surfels at which the next update learns, and reserves memory. Must be called
  /// before record(), and after FieldResources::set_rays() for the update's probes.
  void begin(std::span<const TrainingSurfel> surfels, uint number);
  /// Records the gathers, and the update of the field's corrections from them.
  void record(vulkan::Recorder& to, const DeviceWorld& world);
  /// The number of rays traced, once the recorded commands have run.
  std::uint64_t rays() const;
  std::size_t bytes() const;

 private:
  /// Rays of one depth (see gather_salt()), and what they find.
  struct Gathers {
    vulkan::Buffer rays, points, shaded, direct, arrives;
  };

  void record_gather(vulkan::Recorder& to, const DeviceWorld& world, std::uint32_t count);
  void record_light(vulkan::Recorder& to, const DeviceWorld& world, std::uint32_t rays, int depth);
  void record_secondary_rays(vulkan::Recorder& to, std::uint32_t rays, int depth);
  void record_lookup(vulkan::Recorder& to, const DeviceWorld& world, std::uint32_t rays, int depth);
  void record_compare(vulkan::Recorder& to, const DeviceWorld& world, std::uint32_t count,
                      std::size_t first_sample);

  FieldResources& field_;
  const TrainingKernels& kernels_;
  HitShading shading_;
  uint number_ = 0;
  std::uint32_t surfel_count_ = 0;
  vulkan::Buffer trained_, samples_;
  // Entries of the points that are processed together, and of their rays
  vulkan::Buffer points_, queries_, lookups_;
  std::array<Gathers, 1 + kMaxTrainingSecondaryRays> gathers_;
  vulkan::Buffer first_indices_, secondary_indices_, hits_, hit_queries_;
  vulkan::Buffer ray_count_, rays_read_, shadow_rays_read_, lookup_rays_read_;
};

}  // namespace lambent
