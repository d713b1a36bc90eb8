// SPDX-License-Identifier: Apache-2.0
// The private state of RecordedField.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "field/probes/volumes.h"
#include "field/vulkan/device_schedule.h"
#include "field/vulkan/device_solver.h"
#include "field/vulkan/field_resources.h"
#include "field/vulkan/passes_vulkan.h"
#include "field/vulkan/recorded_arguments.h"
#include "field/vulkan/recorded_plan.h"
#include "raytracing/vulkan/engine_tracer.h"
#include "vulkan/device.h"

namespace lambent {
struct FieldFile;
}

namespace lambent::vulkan {

/// The kernels that only recorded fields run.
struct RecordedKernels {
  RecordedKernels(const Device& device, const FieldSettings& settings, int volumes);

  Kernel rays, fade_samples, blend_weights, surfels, maintain, reset_probes;
};

/// The store's buffers as a descriptor set.
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

/// Memory that the host writes for an update and the device reads until the update has run.
struct UpdateMemory {
  UpdateMemory(const FieldResources& field, const BatchPlan& plan, int rays, bool follows_viewer,
               FloatArray irradiance_weights, FloatArray distance_weights);
  /// Writes the probes and ray directions of a batch.
  void write(const ProbeBatch& batch, const FieldSettings& settings);
  /// Writes the grids after scrolling, and the probes that it recycles.
  void write(const ScrolledVolumes& scrolling);
  /// Returns the passes, with their times, of all parts that have finished since the last call.
  std::vector<PassTime> take_times();
  /// Returns the timestamps of the next part of the update, or null where all have been recorded.
  Timestamps* next_timer() { return parts < timers.size() ? timers[parts++].get() : nullptr; }

  std::size_t bytes() const;
  /// The directions of a ray set of the batch.
  Vec3Array directions_of(int set, int rays) const {
    return {directions.address() + static_cast<std::size_t>(set) * rays * sizeof(vec3)};
  }

  DeviceProbes list;
  std::vector<std::unique_ptr<Timestamps>> timers;  ///< One per part of an update.
  std::size_t parts = 0;                            ///< The number of parts recorded so far.
  Buffer directions, sets;
  Buffer grids, recycled;  ///< Empty where no volume follows the viewer.
  int recycled_count = 0;
};

struct RecordedField::State {
  class EngineRays;

  State(std::shared_ptr<Device> on, const FieldSettings& of, const RecordedFieldSettings& recorded,
        std::span<const Volume> volumes, const ProbeStore& shape);

  /// Checks that the file's volumes are the planned ones, with the tiles that the settings request.
  /// The error contains the file's name.
  Expected<void> check_fit(const std::string& path, const FieldFile& file) const;
  /// Uploads the contents of a file that passed check_fit(). Submits to the device's queue, and
  /// waits.
  void restore(const FieldFile& file);

  /// The volumes after scrolling with the viewer, and the probes that this recycles.
  ScrolledVolumes scroll(const std::optional<vec3>& viewer_ws) const;

  UpdateMemory& memory() { return ring[batch.update % ring.size()]; }
  const DeviceProbes& list() {
    return batch.on_device ? schedule->list(memory().list.sets) : memory().list;
  }
  std::uint32_t ray_count() const {
    return static_cast<std::uint32_t>(batch.count * settings.rays_per_probe);
  }
  ProbeStates probe_states() const { return {{standing.address()}, {states.address()}}; }
  /// Address of the word at this byte offset of the device's ScheduleState; null where the host
  /// schedules.
  UintArray chosen(std::size_t offset) const {
    return {schedule ? schedule->state().address() + offset : 0};
  }
  /// Uploads the record by which engines' shaders look the field up.
  void write_record() const;
  std::size_t bytes() const;
  /// Records a part of an update into an engine's command buffer, between barriers.
  void record_part(EngineRays& source, VkCommandBuffer commands, void (*part)(FieldPasses&));

  std::shared_ptr<Device> device;
  FieldSettings settings;
  std::uint32_t ray_mask;
  uint placing_updates;
  std::vector<VolumeRole> roles;  // one per volume
  std::vector<ProbeGrid> grids;   // the grids after the update that was planned last
  BatchPlan plan;
  FieldResources field;
  DeviceSolver solver;
  RecordedKernels kernels;
  LookupSet lookup_set;
  std::unique_ptr<DeviceSchedule> schedule;  // null: the host plans all batches
  std::unique_ptr<DeviceHistory> history;    // null: averages start again after edits
  ProbeBatch batch;
  Buffer standing, states;  // one entry per probe of the field
  Buffer record;            // the FieldRecord for engines' lookups
  // One entry per probe or ray of an update, and the matrices of its ray sets
  Buffer rays, hits, results, blend_weights, irradiance_weights, distance_weights;
  std::vector<UpdateMemory> ring;
  std::vector<PassTime> times;  // of the last update that has finished
};

/// The rays of a recorded field. An engine traces and shades them; the device computes the schedule
/// and the placement from their results.
class RecordedField::State::EngineRays final : public RaySourceVulkan, public VariabilityVulkan {
 public:
  /// `structure`: the acceleration structure in which `trace` finds hits, and `tracer` traces
  /// visibility rays. Null: neither is asked for.
  explicit EngineRays(State& field, VkAccelerationStructureKHR structure = VK_NULL_HANDLE);

  int batches() const override { return 1; }
  void scroll(Recorder& to) override;
  void schedule(Recorder& to) override;
  void trace(Recorder& to, int batch) override;
  void shade(Recorder& to, int batch) override;
  void visibility(Recorder& to) override;
  /// Returns false: engines shade hits of probe rays only, and not those of gathers.
  bool learns() const override { return false; }
  void corrections(Recorder& /*to*/) override {}
  const DeviceTracer* tracer() const override { return tracer_ ? &*tracer_ : nullptr; }
  void placement(Recorder& to) override;
  void record(Recorder& to, const DeviceProbes& list, FloatArray blend_weights,
              Vec4Array before) override;

 private:
  void record_weights(Recorder& to) const;

  State& s_;
  std::optional<EngineTracer> tracer_;
};

}  // namespace lambent::vulkan
