// SPDX-License-Identifier: Apache-2.0
// The solve for the light of all bounces on a device, like solve_bounces.h. The largest number of
// iterations is recorded, and those after the last one that is needed do nothing. Nothing is read
// back in between.
#pragma once

#include <span>

#include "field/vulkan/field_resources.h"

namespace lambent {

/// The outcome of a solve.
struct DeviceSolve {
  int iterations = 0;
  double error = 0.0;   ///< See SolveResult::error.
  double change = 0.0;  ///< See SolveResult::change.
};

class DeviceSolver {
 public:
  /// The field must outlive the solver.
  explicit DeviceSolver(FieldResources& field);

  /// Reserves memory for a solve for these probes. Must be called before the solve is recorded.
  void reserve(const DeviceProbes& list);

  /// Records solve_bounces(), which reads and replaces the field's light. `blend_weights` and
  /// `history_ratio` are of the list. There is no history ratio where its address is 0.
  void record(vulkan::Recorder& to, const DeviceProbes& list, const vulkan::Buffer& blend_weights,
              float largest_blend_weight, Vec4Array history_ratio, const SolveSettings& settings);

  /// Records solve_counted_bounces(). The list must contain all probes that surfels read.
  void record_bounces(vulkan::Recorder& to, const DeviceProbes& list,
                      const vulkan::Buffer& blend_weights, int bounces);

  std::size_t bytes() const;
  /// The outcome, once the solve has run. Reads it back.
  DeviceSolve result() const;
  /// The solution for the list's probes before blending, and the light that they held before the
  /// solve.
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
