// SPDX-License-Identifier: Apache-2.0
// The passes of an update on a Vulkan device. They record commands, and do not wait. The caller
// submits the commands: VulkanFieldBackend at once, an engine with those of its frame.
#pragma once

#include <vector>

#include "field/edits/device_history.h"
#include "field/passes.h"
#include "field/vulkan/device_schedule.h"
#include "field/vulkan/device_solver.h"
#include "field/vulkan/field_resources.h"
#include "vulkan/recorder.h"

namespace lambent {

/// The source of an update's rays and of their hits and shading: our world, or an engine. The
/// results of its passes are visible to the passes that are recorded afterwards.
class RaySourceVulkan {
 public:
  virtual ~RaySourceVulkan() = default;

  virtual int batches() const = 0;
  virtual void scroll(vulkan::Recorder& to) = 0;
  virtual void schedule(vulkan::Recorder& to) = 0;
  virtual void trace(vulkan::Recorder& to, int batch) = 0;
  /// Records the making of surfels, and of the distances that rays count as.
  virtual void shade(vulkan::Recorder& to, int batch) = 0;
  virtual void visibility(vulkan::Recorder& to) = 0;
  /// Whether the update learns corrections of lookups.
  virtual bool learns() const = 0;
  /// Records gathers, and the update of the corrections from them.
  virtual void corrections(vulkan::Recorder& to) = 0;
  /// The tracer of the visibility rays of lookups, whose textures are bound. Null where lookups
  /// trace no rays.
  virtual const DeviceTracer* tracer() const = 0;
  virtual void placement(vulkan::Recorder& to) = 0;
};

/// Records the use of the changes of the probes' light. Where the host schedules, they are read
/// back; where the device schedules, it learns the probes' variance from them.
class VariabilityVulkan {
 public:
  virtual ~VariabilityVulkan() = default;
  /// `before` is the light that the list's probes held before the update.
  virtual void record(vulkan::Recorder& to, const DeviceProbes& list, FloatArray blend_weights,
                      Vec4Array before) = 0;
};

/// The objects and numbers that the passes of an update work with.
struct UpdateVulkan {
  FieldResources& field;
  DeviceSolver& solver;
  RaySourceVulkan& source;
  VariabilityVulkan& variability;
  const DeviceProbes& list;
  const vulkan::Buffer& blend_weights;  ///< One per probe of the list.
  float largest_blend_weight = 1.0f;
  uint dither_seed = 0;  ///< Seed of the dither with which results are stored.
  /// The history over edits of the list's probes, if their last rays are traced again after edits
  /// and the device solves for their light. Else null.
  DeviceHistory* history = nullptr;
  /// The probes whose surfels may read a probe of the list. Null: lookups of the list itself are
  /// found.
  const DeviceProbes* readers = nullptr;
};

class FieldPassesVulkan final : public FieldPasses {
 public:
  FieldPassesVulkan(vulkan::Recorder& to, const UpdateVulkan& update) : to_(to), update_(update) {}

  const FieldSettings& settings() const override { return update_.field.settings(); }
  int batches() const override { return update_.source.batches(); }

  void scroll() override { update_.source.scroll(to_); }
  void schedule() override { update_.source.schedule(to_); }
  void trace(int batch) override { update_.source.trace(to_, batch); }
  void shade(int batch) override { update_.source.shade(to_, batch); }
  void keep_history() override;
  void move_distances() override;
  void blend_distances() override;
  void visibility() override { update_.source.visibility(to_); }
  bool learns() const override { return update_.source.learns(); }
  void corrections() override { update_.source.corrections(to_); }
  void lookups() override;
  void solve() override;
  void variability() override;
  void store() override;
  void placement() override { update_.source.placement(to_); }

  void begin(const char* name) override { to_.begin_pass(name); }
  void end() override { to_.end_pass(); }

 private:
  vulkan::Recorder& to_;
  UpdateVulkan update_;
};

}  // namespace lambent
