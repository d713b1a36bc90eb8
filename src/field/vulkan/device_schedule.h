// SPDX-License-Identifier: Apache-2.0
// The schedule of a recorded field, decided where its probes are: schedule_arguments.h. Nothing is
// read back.
#pragma once

#include "field/schedule/schedule_arguments.h"
#include "field/vulkan/field_resources.h"

namespace lambent {

class DeviceSchedule {
 public:
  /// Of at most so many probes an update, whole blocks of them, each with so many rays. For a field
  /// that outlives it.
  DeviceSchedule(const FieldResources& field, int most_probes, int rays);

  /// Chooses the probes of an update, counted from 0. `look`: those that are off are looked at
  /// where they have waited too long.
  void record_choose(vulkan::Recorder& to, const ProbeStates& probes, std::uint32_t update,
                     bool look) const;
  /// Books the probes of a list, chosen or not, whose light the field now holds. `shares` and
  /// `before`: of the list's probes, what share of it is new and what they held before.
  void record_update_variability(vulkan::Recorder& to, const DeviceProbes& list,
                                 FloatArray blend_weights, Vec4Array before,
                                 std::uint32_t update) const;

  /// The chosen probes, which all are of ray set 0 among these.
  const DeviceProbes& list(RaySetArray sets) {
    list_.sets = sets;
    return list_;
  }
  /// A ScheduleState.
  const vulkan::Buffer& state() const { return state_; }
  /// ProbeService of all probes, and their bins.
  const vulkan::Buffer& service() const { return service_; }
  const vulkan::Buffer& bins() const { return bins_; }

 private:
  const FieldResources& field_;
  vulkan::Kernel priority_, choose_, list_them_, update_variability_, means_;
  int chunks_;
  DeviceProbes list_;
  vulkan::Buffer state_, service_, bins_, chunk_records_, sizes_, changes_;
};

}  // namespace lambent
