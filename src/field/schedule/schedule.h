// SPDX-License-Identifier: Apache-2.0
// The schedule: which probes an update traces, and with how many rays.
//
// The light of a probe is a mean over updates, whose standard error falls with the square root of
// their number. An update traces the probes with the largest relative standard errors, and gives
// each rays in proportion to its standard deviation. Of all ways to allocate rays, that leaves the
// least error (Neyman, "On the Two Different Aspects of the Representative Method", J. R. Stat.
// Soc. 97(4), 1934). Probes that matter to the visible points, or are near the camera, have a
// larger weight. No probe waits for ever.
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

/// The numbers of rays that a probe may get in an update with a budget. There are few of them, so
/// that many probes share a ray set and its matrix.
inline constexpr std::array kRayClasses = {32, 64, 128, 256, 512};
/// The class nearest to a number of rays.
int ray_class_for(float rays);

/// The most updates that a probe's average remembers. Up to this number it is the mean of all
/// updates; from there on it is an exponential moving average.
inline float longest_average(const FieldSettings& settings) {
  return 1.0f / (1.0f - settings.hysteresis);
}

/// Whether a probe takes part in the schedule: all do but those that are off.
bool is_scheduled(const ProbeStatus& status);

/// Sleeping probes are traced in turns, each once in this many updates or more, see
/// sleeping_period(); those of coarse volumes as many times less often as all probes there. Fog and
/// lookups in open air read them, but no surface does. The largest share of them among the scenes
/// in docs/math.md (57 % of the live probes, in the Cornell box) costs 8 % more rays then.
inline constexpr std::uint32_t kSleepingPeriod = 16;

/// Whether a probe sleeps and holds light, so that it is traced in its turns only. Sleeping probes
/// without light are traced like all others.
bool takes_turns(const ProbeStatus& status);

/// The number of updates in which each of these sleeping probes has one turn: kSleepingPeriod, or
/// more where there are so many of them that their rays would be too large a share of an update's.
/// `live` is the number of the other probes that are not off.
std::uint32_t sleeping_period(int sleeping, int live);

/// The probes of an update, and their numbers of rays.
struct Schedule {
  std::vector<int> probes;  ///< In ascending order.
  std::vector<int> rays;    ///< For each probe, its number of rays.
};

/// Schedules an update without a budget: with the settings' number of rays, every live probe that
/// its volume's level includes in this update, sleeping probes in turns, and every live probe that
/// has never been traced. Where bounces are counted, it schedules all live probes, because an exact
/// number of bounces is carried through all probes at once. `update` counts from 0. `stale` are
/// sleeping probes that edits have not been applied to yet, in ascending order: their turns wait,
/// because their averages would be lost.
Schedule schedule_all(const ProbeStore& store, std::span<const VolumeRole> roles,
                      std::span<const ProbeStatus> statuses, const FieldSettings& settings,
                      std::uint32_t update, std::span<const int> stale = {});

/// Chooses the probes of updates with a budget. It stores the numbers that a probe's urgency
/// depends on, and for each block of probes the largest error reduction and age among them, so that
/// an update visits only probes that changed and urgent ones, however many have converged. Code
/// that changes a probe's status must call mark_changed().
class ProbeScheduler {
 public:
  /// `roles` has one entry per volume.
  ProbeScheduler(int probes, std::span<const VolumeRole> roles, const FieldSettings& settings);

  /// Notes that a probe's status changed.
  void mark_changed(int probe);
  /// Notes that any status may have changed.
  void mark_all_changed() { all_changed_ = true; }

  /// Updates the stored numbers of the probes whose status changed. `statuses` has one entry per
  /// probe.
  void refresh(const ProbeStore& store, std::span<const ProbeStatus> statuses);

  /// The number of probes in each state at the last refresh().
  const ProbeCounts& states() const { return states_; }

  /// The number of live probes that have never been traced, sleeping ones not included.
  int never_traced() const { return never_traced_; }

  /// The most urgent probes within a budget of rays, by the statuses at the last refresh().
  /// `update` counts from 1. `importance` has one number per probe, 0 to 1; if it is empty, probes
  /// are weighted by their distance from the viewer. For `stale`, see schedule_all().
  Schedule choose(const ProbeStore& store, std::uint64_t ray_budget, std::uint32_t update,
                  const std::optional<glm::vec3>& viewer_ws, std::span<const float> importance = {},
                  std::span<const int> stale = {}) const;

 private:
  /// The numbers that a probe's urgency depends on.
  struct Entry {
    float deviation = 0.0f;  ///< probe_deviation() of the probe and its neighbours.
    /// error_reduction() and error_reduction_per_deviation() of the probe, times its weight where
    /// it sleeps; 0: it has converged.
    float reduction = 0.0f;
    float reduction_per_deviation = 0.0f;
    /// Number of the update from which its age counts: of the one that traced it last, and later by
    /// as much as sleeping probes may become older; 0: never traced; the largest number: not live.
    std::uint32_t last_traced = 0;
    ProbeState state = ProbeState::off;
    bool takes_turns = false;
  };
  /// The numbers that an upper bound on the urgency of a block of consecutive probes depends on.
  struct Block {
    float reduction = 0.0f;                ///< The largest of its probes.
    float reduction_per_deviation = 0.0f;  ///< The largest of its probes.
    std::uint32_t last_traced = 0;         ///< The smallest of its probes.
    /// Sum of the deviations, and number, of those near surfaces that have not converged.
    float deviation_sum = 0.0f;
    int unsettled = 0;
  };

  float view_weight(const ProbeStore& store, int probe, const std::optional<glm::vec3>& viewer_ws,
                    std::span<const float> importance) const;
  void refresh_status(std::span<const ProbeStatus> statuses, int probe);
  void refresh_deviation(const ProbeStore& store, std::span<const ProbeStatus> statuses, int probe);
  void refresh_block(std::size_t block);
  float mean_deviation() const;
  int rays_of(const Entry& entry, float mean_deviation) const;

  std::vector<VolumeRole> roles_;
  int rays_per_probe_;
  float longest_;  // the most updates that a probe's average remembers
  std::vector<Entry> entries_;
  std::vector<Block> blocks_;
  std::vector<int> changed_;
  bool all_changed_ = true;
  ProbeCounts states_;
  int never_traced_ = 0;
};

/// Groups the scheduled probes by their numbers of rays, and draws the directions of each ray set.
std::vector<TraceGroup> group_by_rays(const Schedule& schedule, const FieldSettings& settings,
                                      uint update);

/// Moves the probes that take turns out of the groups, into groups of their own, which share the
/// ray sets. Groups that become empty are removed.
std::vector<TraceGroup> split_turns(std::vector<TraceGroup>& groups,
                                    std::span<const ProbeStatus> statuses);

/// Learns a probe's variance from the difference between the light that its rays estimated and the
/// light that it held: `relative_square` is the mean square of that difference, divided by the
/// square of the mean. The rays amount to `weight` updates with FieldSettings::rays_per_probe rays,
/// and the probe held an average of `status.samples` such updates. Then adds `weight` to the
/// samples.
void learn_variance(float relative_square, float weight, ProbeStatus& status);

}  // namespace lambent
