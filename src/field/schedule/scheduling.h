// SPDX-License-Identifier: Apache-2.0
// The state of the schedule: the scheduler, the weights of probes, and the measured costs of rays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/field_backend.h"
#include "field/probes/probe_status.h"
#include "field/schedule/schedule.h"
#include "field/schedule/update_costs.h"

namespace lambent {

struct Scheduling {
  ProbeScheduler scheduler;
  std::vector<float> importance = {};  ///< Per probe; empty where an update has no visible points.
  RayCost ray_cost = {};
  EditCost edit_cost = {};
  bool warming_up = true;   ///< Whether some live probe has not been traced since the start.
  float mean_light = 0.0f;  ///< Mean luminance of the live probes.
};

/// The probes that an update traces, and the weights of their new rays.
struct TracedProbes {
  std::vector<int> probes;
  /// For each probe, the weight of the new light in the blend with its history, 0 to 1.
  std::vector<float> blend_weights;
  /// For each probe, its number of new rays over FieldSettings::rays_per_probe.
  std::vector<float> weights;
};

/// Computes the weights of the groups' rays in the blend with their probes' history. History of n
/// updates and new rays that amount to w updates blend with the weight w / (n + w), where n is
/// limited by the hysteresis.
TracedProbes blend_weights_of(std::span<const TraceGroup> groups, const FieldSettings& settings,
                              std::span<const ProbeStatus> statuses);

/// The update and the world in which probes were traced.
struct TracedIn {
  std::uint32_t update = 0;    ///< Number of the update, counted from 1.
  std::uint64_t revision = 0;  ///< Revision of the world.
};

/// Learns the variance of the traced probes from the changes of their light, counts their samples,
/// and stores when they were traced.
void update_variability(const TracedProbes& traced, std::span<const LightChange> changes,
                        const TracedIn& in, const FieldSettings& settings,
                        std::span<ProbeStatus> statuses, Scheduling& scheduling);

/// Sets a probe's number of samples to 0, so that its average starts again, and its revision to
/// this revision of the world.
void reset_history(int probe, std::uint64_t revision, std::span<ProbeStatus> statuses,
                   ProbeScheduler& scheduler);

}  // namespace lambent
