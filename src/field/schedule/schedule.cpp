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

}  // namespace

bool is_scheduled(const ProbeStatus& status) {
  if (status.state == ProbeState::off) return false;
  // Fog and lookups in open air need the light of sleeping probes: these are traced once, and again
  // where their history was reset
  return status.state != ProbeState::sleeping || status.last_traced == 0 || status.samples == 0.0f;
}

int ray_class_for(float rays) {
  for (const int count : kRayClasses) {
    if (rays <= kBetweenClasses * static_cast<float>(count)) return count;
  }
  return kRayClasses.back();
}

Schedule schedule_all(const ProbeStore& store, std::span<const VolumeRole> roles,
                      std::span<const ProbeStatus> statuses, const FieldSettings& settings,
                      std::uint32_t update) {
  Schedule schedule;
  for (int volume = 0; volume < store.volumes(); ++volume) {
    const std::uint32_t period = settings.max_bounces >= 0 ? 1u : 1u << roles[volume].level;
    const int first = store.grid(volume).first;
    for (int probe = first; probe < first + probe_count(store.grid(volume)); ++probe) {
      if (!is_scheduled(statuses[probe])) continue;
      // Spread the probes of a coarse volume over its updates
      const bool turn = (update + static_cast<std::uint32_t>(probe)) % period == 0;
      if (turn || statuses[probe].last_traced == 0) schedule.probes.push_back(probe);
    }
  }
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

void learn_variance(float relative_square, float weight, ProbeStatus& status) {
  const VarianceEstimate known = {status.variance, status.variance_samples};
  const VarianceEstimate learned = learned_variance(known, relative_square, weight, status.samples);
  status.variance = learned.variance;
  status.variance_samples = static_cast<std::uint16_t>(learned.samples);
  status.samples += weight;
}

}  // namespace lambent
