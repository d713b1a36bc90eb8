// SPDX-License-Identifier: Apache-2.0
// The history of probes over edits, on a device: the twin of apply_scene_edits.cpp on the host. It
// is for fields that engines record, from which the host reads nothing back.
#pragma once

#include "field/edits/edit_arguments.h"
#include "field/vulkan/device_solver.h"
#include "field/vulkan/field_resources.h"

namespace lambent {

class DeviceHistory {
 public:
  /// Makes kernels, and memory for lists up to the `largest`. All arguments must outlive it.
  DeviceHistory(FieldResources& field, DeviceSolver& solver, const ProbeStates& probes,
                const DeviceProbes& largest);

  // Passes, in this order. What they read must be visible before them, and what they write is
  // visible after them.

  /// Records the computation of the history ratios of a list's probes, and of the distances and the
  /// direct light along their rays. Light and surfels must still be those from before the edits.
  void record_before(vulkan::Recorder& to, const DeviceProbes& list);
  /// Records the solve for the light of the list's probes after the edits, once their surfels and
  /// lookups are up to date. `blend_weights` are 1.
  void record_solve(vulkan::Recorder& to, const DeviceProbes& list,
                    const vulkan::Buffer& blend_weights);
  /// Records that probes whose light the edits did not change visibly get their old light back, and
  /// that the numbers of samples of the others are reduced.
  void record_keep(vulkan::Recorder& to, const DeviceProbes& list) const;
  /// One word per probe of the list: 1 where its light changed, else 0.
  UintArray changed() const { return {changed_.address()}; }

  std::size_t bytes() const;

 private:
  FieldResources& field_;
  DeviceSolver& solver_;
  ProbeStates probes_;
  vulkan::Kernel gather_tiles_, history_ratio_kernel_, scale_light_, keep_unchanged_;
  // Entries of the list's probes
  vulkan::Buffer light_before_, estimate_, history_ratio_, edited_light_;
  vulkan::Buffer mean_probe_, history_shares_, changed_;
};

}  // namespace lambent
