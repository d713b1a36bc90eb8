// SPDX-License-Identifier: Apache-2.0
// What decides which probes are traced, and what is learned of those that were.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/field_backend.h"
#include "field/probes/probe_status.h"
#include "field/schedule/schedule.h"

namespace lambent {

struct Scheduling {
  ProbeScheduler scheduler;
  std::vector<float> importance = {};  ///< Per probe; empty where an update has no visible points.
  RayCost ray_cost = {};               ///< Of updates that trace new rays.
  RayCost edit_cost = {};   ///< Of edits that are applied. Learning corrections is no part of it.
  bool warming_up = true;   ///< Some live probe has not been traced since the start.
  float mean_light = 0.0f;  ///< Mean luminance of the live probes.
};

/// The probes that an update traces, and how much their new rays count.
struct TracedProbes {
  std::vector<int> probes;
  /// For each probe, the weight of the new light in the blend with its history, 0 to 1.
  std::vector<float> blend_weights;
  /// For each probe, its number of new rays over FieldSettings::rays_per_probe.
  std::vector<float> weights;
};

/// Computes how much the groups' rays will count in the blend with their probes' history: all
/// history of n updates' worth of rays and w new ones blend with the weight w / (n + w), where n is
/// limited by the hysteresis.
TracedProbes blend_weights_of(std::span<const TraceGroup> groups, const FieldSettings& settings,
                              std::span<const ProbeStatus> statuses);

/// The update and the world in which probes were traced.
struct TracedIn {
  std::uint32_t update = 0;  ///< Its number, counted from 1.
  std::uint64_t revision = 0;
};

/// Learns the variance of the traced probes from how much their light changed, counts their
/// samples, and notes that they were traced.
void update_variability(const TracedProbes& traced, std::span<const LightChange> changes,
                        const TracedIn& in, const FieldSettings& settings,
                        std::span<ProbeStatus> statuses, Scheduling& scheduling);

/// Lets a probe start its average again at this revision of the world.
void reset_history(int probe, std::uint64_t revision, std::span<ProbeStatus> statuses,
                   ProbeScheduler& scheduler);

}  // namespace lambent
