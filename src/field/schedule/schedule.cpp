// SPDX-License-Identifier: Apache-2.0
#include "field/schedule/schedule.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace lambent {
namespace {

// Numbers of rays up to this factor above a class belong to the class. It is the square root of the
// ratio of two classes.
constexpr float kBetweenClasses = 1.41421356f;

// Sleeping probes are traced with about this share of the rays of all others, so that light in open
// air, which few programs read, costs surfaces little; with more where the period would be longer
// than the longest.
constexpr float kSleepingShare = 0.1f;
// The longest period of turns of sleeping probes, of volumes of level 0: one second at 60 Hz. It
// limits how slowly light converges in fields that have hardly any other probes, whose updates cost
// little.
constexpr std::uint32_t kLongestSleepingPeriod = 64;
// An update takes at most this many times the sleeping probes of an even share of the period. About
// twice as many fall due where every second update traces nothing, and up to all of them where the
// period changes as things begin to move.
constexpr std::size_t kMostOverShare = 3;

/// 2^32 over the golden ratio. Its multiples modulo 2^32 are evenly spread, and so are those of any
/// run of indices, or of every nth of them: Knuth, The Art of Computer Programming 3, sec. 6.4.
constexpr std::uint32_t kGoldenStep = 2654435769u;

/// Whether a probe has had a turn since it was traced last. The turn waits where an update traces
/// nothing: while edits go on, every second one does not.
bool has_turn(int probe, std::uint32_t last_traced, std::uint32_t update, std::uint32_t period) {
  // Probes begin their periods in different updates, so that all updates trace about as many
  const std::uint64_t spread = static_cast<std::uint32_t>(probe) * kGoldenStep;
  const auto phase = static_cast<std::uint32_t>(spread * period >> 32u);
  // Updates count from 0, but those that traced a probe last from 1
  return (update + phase) / period != (last_traced - 1 + phase) / period;
}

/// Removes the turns beyond the most that an update takes, the latest ones first. `due`: probes in
/// ascending order; `most`: of them.
void limit_turns(std::vector<int>& due, std::size_t most, std::span<const ProbeStatus> statuses) {
  if (due.size() <= most) return;
  std::stable_sort(due.begin(), due.end(),
                   [&](int a, int b) { return statuses[a].last_traced < statuses[b].last_traced; });
  due.resize(most);
  std::sort(due.begin(), due.end());
}

}  // namespace

bool is_scheduled(const ProbeStatus& status) {
  return status.state != ProbeState::off;
}

bool takes_turns(const ProbeStatus& status) {
  return status.state == ProbeState::sleeping && status.last_traced > 0 && status.samples > 0.0f;
}

std::uint32_t sleeping_period(int sleeping, int live) {
  const float enough =
      static_cast<float>(sleeping) / (kSleepingShare * static_cast<float>(std::max(live, 1)));
  const float longest = static_cast<float>(kLongestSleepingPeriod);
  return std::max(kSleepingPeriod,
                  static_cast<std::uint32_t>(std::ceil(std::min(enough, longest))));
}

int ray_class_for(float rays) {
  for (const int count : kRayClasses) {
    if (rays <= kBetweenClasses * static_cast<float>(count)) return count;
  }
  return kRayClasses.back();
}

Schedule schedule_all(const ProbeStore& store, std::span<const VolumeRole> roles,
                      std::span<const ProbeStatus> statuses, const FieldSettings& settings,
                      std::uint32_t update, std::span<const int> stale) {
  Schedule schedule;
  const auto sleeping = std::count_if(statuses.begin(), statuses.end(), takes_turns);
  const auto all = std::count_if(statuses.begin(), statuses.end(), is_scheduled);
  const std::uint32_t turns =
      sleeping_period(static_cast<int>(sleeping), static_cast<int>(all - sleeping));
  std::vector<int> due;
  for (int volume = 0; volume < store.volumes(); ++volume) {
    const std::uint32_t period = settings.max_bounces >= 0 ? 1u : 1u << roles[volume].level;
    const int first = store.grid(volume).first;
    for (int probe = first; probe < first + probe_count(store.grid(volume)); ++probe) {
      const ProbeStatus& status = statuses[probe];
      if (!is_scheduled(status)) continue;
      if (takes_turns(status)) {
        if (has_turn(probe, status.last_traced, update, turns * period) &&
            !std::binary_search(stale.begin(), stale.end(), probe)) {
          due.push_back(probe);
        }
        continue;
      }
      // Spread the probes of a coarse volume over its updates
      const bool turn = (update + static_cast<std::uint32_t>(probe)) % period == 0;
      if (turn || status.last_traced == 0) schedule.probes.push_back(probe);
    }
  }
  limit_turns(due, kMostOverShare * (static_cast<std::size_t>(sleeping) / turns + 1), statuses);
  const auto others = static_cast<std::ptrdiff_t>(schedule.probes.size());
  schedule.probes.insert(schedule.probes.end(), due.begin(), due.end());
  std::inplace_merge(schedule.probes.begin(), schedule.probes.begin() + others,
                     schedule.probes.end());
  schedule.rays.assign(schedule.probes.size(), settings.rays_per_probe);
  return schedule;
}

std::vector<TraceGroup> group_by_rays(const Schedule& schedule, const FieldSettings& settings,
                                      uint update) {
  std::vector<TraceGroup> groups;
  for (std::size_t k = 0; k < schedule.probes.size(); ++k) {
    const auto same = [&](const TraceGroup& group) {
      return group.rays->rays() == schedule.rays[k];
    };
    auto group = std::find_if(groups.begin(), groups.end(), same);
    if (group == groups.end()) {
      groups.push_back({std::make_shared<RaySet>(settings, schedule.rays[k], update), {}, {}});
      group = groups.end() - 1;
    }
    group->probes.push_back(schedule.probes[k]);
  }
  return groups;
}

std::vector<TraceGroup> split_turns(std::vector<TraceGroup>& groups,
                                    std::span<const ProbeStatus> statuses) {
  std::vector<TraceGroup> in_turn;
  for (TraceGroup& group : groups) {
    const auto first = std::stable_partition(group.probes.begin(), group.probes.end(),
                                             [&](int i) { return !takes_turns(statuses[i]); });
    if (first == group.probes.end()) continue;
    in_turn.push_back({group.rays, {first, group.probes.end()}, {}});
    group.probes.erase(first, group.probes.end());
  }
  std::erase_if(groups, [](const TraceGroup& group) { return group.probes.empty(); });
  return in_turn;
}

void learn_variance(float relative_square, float weight, ProbeStatus& status) {
  const VarianceEstimate known = {status.variance, status.variance_samples};
  const VarianceEstimate learned = learned_variance(known, relative_square, weight, status.samples);
  status.variance = learned.variance;
  status.variance_samples = static_cast<std::uint16_t>(learned.samples);
  status.samples += weight;
}

}  // namespace lambent
