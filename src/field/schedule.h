// SPDX-License-Identifier: Apache-2.0
// Which probes an update traces, with how many rays.
//
// The light of a probe is a mean over updates; its standard error falls with the square root of
// their number. An update serves the probes with the largest relative standard errors, and gives
// each rays in proportion to its noise: of all ways to share out rays, that leaves the least error
// (Neyman, "On the Two Different Aspects of the Representative Method", J. R. Stat. Soc. 97(4),
// 1934). Probes near the camera count for more, and none waits for ever.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "field/probe_record.h"
#include "field/probe_store.h"
#include "field/surfels.h"
#include "field/volumes.h"

namespace lambent {

/// Updates after which a probe is served in any case, where the budget allows: two seconds at 60
/// Hz.
inline constexpr std::uint32_t kMaxProbeAge = 128;

/// Learns what a ray costs.
class RayCost {
 public:
  /// Remembers what an update took.
  void learn(std::uint64_t rays, double ms);
  /// Rays to trace within a time, at least one probe's.
  std::uint64_t rays_within(double ms) const;

 private:
  double ms_per_ray_ = 0.0;  // 0: nothing learned yet
};

struct Schedule {
  std::vector<int> probes;  ///< In ascending order.
  std::vector<int> rays;    ///< Of each, one of the ray classes.
};

/// Every probe that is not off and whose volume's turn it is, and those never served, with the
/// settings' rays. `update` counts from 1.
Schedule schedule_all(const ProbeStore& store, std::span<const VolumeRole> roles,
                      std::span<const ProbeRecord> records, int rays_per_probe,
                      std::uint32_t update);

/// The most urgent probes within a budget of rays, likewise.
Schedule schedule_within(const ProbeStore& store, std::span<const VolumeRole> roles,
                         std::span<const ProbeRecord> records, const FieldSettings& settings,
                         std::uint64_t ray_budget, std::uint32_t update,
                         const std::optional<glm::vec3>& viewer_ws);

/// Groups the scheduled probes by their rays, and draws the rays' directions.
std::vector<TraceGroup> group_by_rays(const Schedule& schedule, const FieldSettings& settings,
                                      uint update);

/// Learns a probe's noise from how far the light that its rays told is from what it held: the mean
/// square of their difference over the square of their mean, where `weight` updates' worth of rays
/// told it and the probe had averaged `record.samples` before. Then counts the new rays in.
void learn_noise(float relative_square, float weight, ProbeRecord& record);

}  // namespace lambent
