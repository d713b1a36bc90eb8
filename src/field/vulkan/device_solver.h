// SPDX-License-Identifier: Apache-2.0
// The solve for the light of all bounces on a device: relight.h. Iterations are recorded as many as
// there may be; those after the last one needed find that they have nothing to do. Nothing is read
// back in between.
#pragma once

#include <span>

#include "field/field_backend.h"
#include "field/vulkan/field_resources.h"

namespace lambent {

class DeviceSolver {
 public:
  /// For a field that outlives it.
  explicit DeviceSolver(FieldResources& field);

  /// Makes room to solve for these: before it is recorded.
  void reserve(const DeviceProbes& list);

  /// As relight, from the light that the field holds and into it. `shares` are of the list's
  /// probes, and so is `gain`, none where its address is 0.
  void record(vulkan::Recorder& to, const DeviceProbes& list, const vulkan::Buffer& blend_weights,
              float largest_blend_weight, Vec4Array history_ratio, const SolveSettings& settings);

  /// As solve_counted_bounces. The list must be of all probes that are read.
  void record_bounces(vulkan::Recorder& to, const DeviceProbes& list,
                      const vulkan::Buffer& blend_weights, int bounces);

  /// What it came to, once that has run.
  DeviceSolve result() const;
  /// What was solved for before a share of it was blended in, of the list's probes, and the light
  /// that they held before.
  const vulkan::Buffer& solution() const { return image_; }
  const vulkan::Buffer& history() const { return history_; }

 private:
  SolveArrays arrays(const DeviceProbes& list, const vulkan::Buffer& blend_weights) const;
  void record_begin(vulkan::Recorder& to, const DeviceProbes& list, const SolveArrays& arrays,
                    SolveState state) const;
  void take_chosen(vulkan::Recorder& to, const vulkan::Buffer& chosen) const;
  void record_end(vulkan::Recorder& to, const DeviceProbes& list, const SolveArrays& arrays) const;
  void blend_solution(vulkan::Recorder& to, const DeviceProbes& list, const SolveArrays& arrays,
                      uint step) const;

  FieldResources& field_;
  vulkan::Buffer state_, sums_;
  vulkan::Buffer history_, solution_, image_, residual_, previous_image_;
  vulkan::Buffer residual_changes_, image_changes_;
};

}  // namespace lambent
