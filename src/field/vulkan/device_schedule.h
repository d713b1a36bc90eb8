// SPDX-License-Identifier: Apache-2.0
// The schedule of a recorded field, which the device decides itself (schedule_arguments.h). Nothing
// is read back.
#pragma once

#include <span>

#include "field/probes/volumes.h"
#include "field/schedule/schedule_arguments.h"
#include "field/vulkan/field_resources.h"

namespace lambent {

class DeviceSchedule {
 public:
  /// Schedules at most `most_probes` per update, a multiple of kBlockProbes, with `rays` rays each.
  /// `roles` has one entry per volume. The field must outlive the schedule.
  DeviceSchedule(const FieldResources& field, std::span<const VolumeRole> roles, int most_probes,
                 int rays);

  /// Uploads the variability of all probes, and the mean luminance of their light. Must not be
  /// called while the device uses the schedule.
  void start_from(std::span<const ProbeVariability> variability, float mean_light);

  /// Records the choice of an update's probes. `update` counts from 0. With `look`, probes that are
  /// off are traced as well if they waited for kMaxProbeAge.
  void record_choose(vulkan::Recorder& to, const ProbeStates& probes, std::uint32_t update,
                     bool look) const;
  /// Records the update of the variance of a list's probes, which now hold new light.
  /// `blend_weights` are the weights of the new light, and `before` is the light that the probes
  /// held, both of the list.
  void record_update_variability(vulkan::Recorder& to, const DeviceProbes& list,
                                 FloatArray blend_weights, Vec4Array before,
                                 std::uint32_t update) const;

  /// The chosen probes. All use ray set 0 of `sets`.
  const DeviceProbes& list(RaySetArray sets) {
    list_.sets = sets;
    return list_;
  }
  std::size_t bytes() const;
  /// Holds a ScheduleState.
  const vulkan::Buffer& state() const { return state_; }
  /// Hold the ProbeVariability and the priority bin of each probe.
  const vulkan::Buffer& variability() const { return variability_; }
  const vulkan::Buffer& bins() const { return bins_; }

 private:
  const FieldResources& field_;
  vulkan::Kernel priority_, choose_, list_them_, update_variability_, means_;
  int chunks_;
  DeviceProbes list_;
  vulkan::Buffer levels_, state_, variability_, bins_, chunk_records_, sizes_, changes_;
};

}  // namespace lambent
