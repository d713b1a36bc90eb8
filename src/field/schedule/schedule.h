// SPDX-License-Identifier: Apache-2.0
// Which probes an update traces, with how many rays.
//
// The light of a probe is a mean over updates; its standard error falls with the square root of
// their number. An update serves the probes with the largest relative standard errors, and gives
// each rays in proportion to its noise: of all ways to share out rays, that leaves the least error
// (Neyman, "On the Two Different Aspects of the Representative Method", J. R. Stat. Soc. 97(4),
// 1934). Probes that matter to what is seen, or near the camera, count for more, and none waits for
// ever.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "field/probes/volumes.h"
#include "field/schedule/schedule_math.h"
#include "field/transport/surfels.h"

namespace lambent {

/// Rays of a probe in an update with a budget, as many as its noise asks for. Few classes, so that
/// many probes share one set of directions and its blend matrix.
inline constexpr std::array kRayClasses = {32, 64, 128, 256, 512};
/// The class nearest to so many rays.
int ray_class_for(float rays);

/// Updates that a probe's average remembers: the mean of all so far, until it has become an
/// exponential moving average.
inline float longest_average(const FieldSettings& settings) {
  return 1.0f / (1.0f - settings.hysteresis);
}

/// Whether a probe takes part in updates.
bool is_live(const ProbeStatus& status);

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
/// settings' rays. Where bounces are counted it is every volume's turn: their exact number is
/// carried through all probes at once.
Schedule schedule_all(const ProbeStore& store, std::span<const VolumeRole> roles,
                      std::span<const ProbeStatus> statuses, const FieldSettings& settings,
                      std::uint32_t update);

/// What the scheduler keeps in mind of each probe, so that an update looks at those that changed
/// and those that are urgent, however many rest: blocks of probes know the largest gain and the age
/// among them. Whoever changes a record tells.
class ProbeScheduler {
 public:
  /// Roles are one a volume.
  ProbeScheduler(int probes, std::span<const VolumeRole> roles, const FieldSettings& settings);

  /// A probe's record changed, or all did.
  void mark_changed(int probe);
  void mark_all_changed() { all_changed_ = true; }

  /// Takes note of the changes. Records are one a probe.
  void refresh(const ProbeStore& store, std::span<const ProbeStatus> statuses);

  /// How many probes are in each state, as last noted.
  const ProbeCounts& states() const { return states_; }

  /// Probes that light something and have never been served.
  int unserved() const { return unserved_; }

  /// The most urgent probes within a budget of rays, as last noted. `update` counts from 1.
  /// `importance` has one number a probe, 0 to 1; empty: by the distance from the viewer.
  Schedule choose(const ProbeStore& store, std::uint64_t ray_budget, std::uint32_t update,
                  const std::optional<glm::vec3>& viewer_ws,
                  std::span<const float> importance = {}) const;

 private:
  /// What decides about a probe.
  struct Entry {
    float noise = 0.0f;  ///< Standard deviation of what an update tells, around the probe.
    float reduction =
        0.0f;  ///< By how much its error falls with each ray, in proportion; 0: it rests.
    float reduction_per_noise = 0.0f;  ///< The same per noise.
    std::uint32_t served = 0;  ///< Update that served it last; 0: none; the largest: not live.
    ProbeState state = ProbeState::off;
  };
  /// What decides about a block of probes that follow one another.
  struct Block {
    float reduction = 0.0f;            ///< The largest.
    float reduction_per_noise = 0.0f;  ///< Likewise.
    std::uint32_t served = 0;          ///< The smallest.
    float noise_sum = 0.0f;            ///< Of the probes that do not rest, ...
    int unsettled = 0;                 ///< ... so many.
  };

  float view_weight(const ProbeStore& store, int probe, const std::optional<glm::vec3>& viewer_ws,
                    std::span<const float> importance) const;
  void refresh_status(std::span<const ProbeStatus> statuses, int probe);
  void refresh_noise(const ProbeStore& store, std::span<const ProbeStatus> statuses, int probe);
  void refresh_block(std::size_t block);
  float mean_noise() const;
  int rays_of(const Entry& entry, float mean_noise) const;

  std::vector<VolumeRole> roles_;
  int rays_per_probe_;
  float longest_;  // updates that a probe's average remembers
  std::vector<Entry> entries_;
  std::vector<Block> blocks_;
  std::vector<int> changed_;
  bool all_changed_ = true;
  ProbeCounts states_;
  int unserved_ = 0;
};

/// Groups the scheduled probes by their rays, and draws the rays' directions.
std::vector<TraceGroup> group_by_rays(const Schedule& schedule, const FieldSettings& settings,
                                      uint update);

/// Learns a probe's noise from how far the light that its rays told is from what it held: the mean
/// square of their difference over the square of their mean, where `weight` updates' worth of rays
/// told it and the probe had averaged `record.samples` before. Then counts the new rays in.
void learn_noise(float relative_square, float weight, ProbeStatus& status);

}  // namespace lambent
