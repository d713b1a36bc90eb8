// SPDX-License-Identifier: Apache-2.0
// All that a recorded field consists of.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "field/vulkan/device_schedule.h"
#include "field/vulkan/device_solver.h"
#include "field/vulkan/field_resources.h"
#include "field/vulkan/recorded_arguments.h"
#include "field/vulkan/recorded_plan.h"
#include "vulkan/device.h"

namespace lambent::vulkan {

/// The kernels of recorded fields alone.
struct RecordedKernels {
  RecordedKernels(const Device& device, const FieldSettings& settings, int volumes);

  Kernel rays, fade_samples, blend_weights, surfels, maintain;
};

/// The pipeline that traces in engines' structures, which all fields on a device share.
struct EngineTracer {
  explicit EngineTracer(const Device& device);

  RayKernel closest;
};

/// The store as descriptors.
class LookupSet {
 public:
  LookupSet(const Device& device, const FieldResources& field);
  ~LookupSet();
  LookupSet(const LookupSet&) = delete;
  LookupSet& operator=(const LookupSet&) = delete;

  VkDescriptorSetLayout layout() const { return layout_; }
  VkDescriptorSet set() const { return set_; }

 private:
  const Device& device_;
  VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// What the host writes for an update, and the device reads until that has run.
struct UpdateMemory {
  UpdateMemory(const FieldResources& field, int most_probes, int rays,
               FloatArray irradiance_weights, FloatArray distance_weights);
  /// Fills in the probes and rays of a turn.
  void write(const ProbeBatch& batch, const FieldSettings& settings);

  DeviceProbes list;
  Buffer directions, set;
};

struct RecordedField::State {
  State(std::shared_ptr<Device> on, const FieldSettings& of, const RecordedFieldSettings& recorded,
        const ProbeStore& shape);

  UpdateMemory& memory() { return ring[batch.update % ring.size()]; }
  const DeviceProbes& list() {
    return batch.on_device ? schedule->list(memory().list.sets) : memory().list;
  }
  std::uint32_t ray_count() const {
    return static_cast<std::uint32_t>(batch.count * settings.rays_per_probe);
  }
  ProbeStates probe_states() const { return {{standing.address()}, {states.address()}}; }
  /// A word of what the device decided; none where it does not.
  UintArray chosen(std::size_t offset) const {
    return {schedule ? schedule->state().address() + offset : 0};
  }
  void record_results(Recorder& to);

  std::shared_ptr<Device> device;
  FieldSettings settings;
  std::uint32_t ray_mask;
  BatchPlan plan;
  FieldResources field;
  DeviceSolver solver;
  RecordedKernels kernels;
  const EngineTracer& tracer;
  LookupSet lookup_set;
  std::unique_ptr<DeviceSchedule> schedule;  // null: by turns
  ProbeBatch batch;
  // All but the first are of an update's probes or rays
  Buffer standing, states, record;
  Buffer rays, hits, results, blend_weights, irradiance_weights, distance_weights;
  std::vector<UpdateMemory> ring;
};

}  // namespace lambent::vulkan
