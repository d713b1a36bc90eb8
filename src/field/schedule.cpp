// SPDX-License-Identifier: Apache-2.0
#include "field/schedule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

namespace lambent {
namespace {

// Rays of a probe in an update with a budget, as many as its noise asks for. Few classes, so that
// many probes share one set of directions and its blend matrix.
constexpr std::array kRayClasses = {32, 64, 128, 256, 512};
// From a class on to where the next one is as near, as a factor: the root of their ratio.
constexpr float kBetweenClasses = 1.41421356f;

// A probe whose light is known this well rests until its age calls it: surfaces average the noise
// of eight.
constexpr float kSettledError = 0.01f;

// A probe is worth half as much so many cells away from the camera.
constexpr float kHalfWorthCells = 16.0f;

// The noise of a probe follows about so many of its last updates.
constexpr float kNoiseMemory = 8.0f;
// Noise below this is not believed after few updates: a probe that saw nothing bright yet may.
constexpr float kMinNoise = 1e-4f;

// Share of the new cost in what a ray is held to cost.
constexpr double kCostShare = 0.2;
// Assumed of a ray before any was timed [ms]: a slow processor's.
constexpr double kFirstGuessMs = 1e-3;

bool is_live(const ProbeRecord& record) {
  if (record.state == ProbeState::off) return false;
  // Points in open air may be asked about: a sleeping probe is traced once
  return record.state != ProbeState::sleeping || record.served == 0;
}

int class_for(float rays) {
  for (const int count : kRayClasses) {
    if (rays <= kBetweenClasses * static_cast<float>(count)) return count;
  }
  return kRayClasses.back();
}

/// Relative variance of what one update tells of a probe, as its neighbours have it on average: a
/// probe's own is the lower the less of what is bright it has met so far, and resting on it would
/// leave the light too dark for good.
float noise_around(const ProbeGrid& grid, std::span<const ProbeRecord> records, int probe) {
  const ivec3 place = probe_coords(grid, probe);
  float sum = records[probe].noise;
  int count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      ivec3 next = place;
      next[axis] += side;
      if (next[axis] < 0 || next[axis] >= grid.count[axis]) continue;
      const ProbeRecord& record = records[probe_index(grid, next)];
      if (!is_live(record)) continue;
      sum += record.noise;
      ++count;
    }
  }
  return sum / static_cast<float>(count);
}

struct Candidate {
  float urgency;
  float noise;  // standard deviation
  int probe;
};

}  // namespace

void RayCost::learn(std::uint64_t rays, double ms) {
  if (rays == 0) return;
  const double cost = ms / static_cast<double>(rays);
  ms_per_ray_ = ms_per_ray_ == 0.0 ? cost : ms_per_ray_ + kCostShare * (cost - ms_per_ray_);
}

std::uint64_t RayCost::rays_within(double ms) const {
  const double cost = ms_per_ray_ == 0.0 ? kFirstGuessMs : ms_per_ray_;
  return std::max<std::uint64_t>(kRayClasses.front(), static_cast<std::uint64_t>(ms / cost));
}

Schedule schedule_all(const ProbeStore& store, std::span<const VolumeRole> roles,
                      std::span<const ProbeRecord> records, int rays_per_probe,
                      std::uint32_t update) {
  Schedule schedule;
  for (int volume = 0; volume < store.volumes(); ++volume) {
    const std::uint32_t period = 1u << roles[volume].level;
    const int first = store.grid(volume).first;
    for (int probe = first; probe < first + probe_count(store.grid(volume)); ++probe) {
      if (!is_live(records[probe])) continue;
      // Not all of a volume's probes in the same update
      const bool turn = (update + static_cast<std::uint32_t>(probe)) % period == 0;
      if (turn || records[probe].served == 0) schedule.probes.push_back(probe);
    }
  }
  schedule.rays.assign(schedule.probes.size(), rays_per_probe);
  return schedule;
}

Schedule schedule_within(const ProbeStore& store, std::span<const VolumeRole> roles,
                         std::span<const ProbeRecord> records, const FieldSettings& settings,
                         std::uint64_t ray_budget, std::uint32_t update,
                         const std::optional<glm::vec3>& viewer_ws) {
  // Compute how urgent each probe is: by the error it has, and beyond all others where it is old
  std::vector<Candidate> candidates;
  candidates.reserve(records.size());
  double noise_sum = 0.0;
  const float longest = 1.0f / (1.0f - settings.hysteresis);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const ProbeRecord& record = records[i];
    if (!is_live(record)) continue;
    const int probe = static_cast<int>(i);
    const std::uint32_t age = update - record.served;
    const bool old = record.served == 0 || age >= kMaxProbeAge;
    if (!old && record.samples >= longest) continue;
    const int volume = store.volume_of(probe);
    const ProbeGrid& grid = store.grid(volume);
    const float noise = std::sqrt(noise_around(grid, records, probe));
    const float error = noise / std::sqrt(std::max(record.samples, 1.0f));
    if (!old && error < kSettledError) continue;
    float worth = std::ldexp(1.0f, -roles[volume].level);
    if (viewer_ws) {
      const float cell = max(grid.spacing.x, max(grid.spacing.y, grid.spacing.z));
      const float cells = length(store.probe_position_ws(probe) - *viewer_ws) / cell;
      worth *= kHalfWorthCells / (kHalfWorthCells + cells);
    }
    const float urgency = old ? static_cast<float>(age) + 1.0f : std::min(error * worth, 1.0f);
    candidates.push_back({urgency, noise, probe});
    noise_sum += noise;
  }
  if (candidates.empty()) return {};
  const double mean_noise = noise_sum / static_cast<double>(candidates.size());

  // Serve them in that order until the rays are spent; no more than could be served need sorting
  const std::size_t most =
      std::min<std::size_t>(candidates.size(), ray_budget / kRayClasses.front() + 1);
  const auto more_urgent = [](const Candidate& a, const Candidate& b) {
    return a.urgency != b.urgency ? a.urgency > b.urgency : a.probe < b.probe;
  };
  std::nth_element(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(most - 1),
                   candidates.end(), more_urgent);
  std::sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(most),
            more_urgent);
  std::vector<std::pair<int, int>> chosen;
  std::uint64_t spent = 0;
  for (std::size_t i = 0; i < most; ++i) {
    const double share = mean_noise > 0.0 ? candidates[i].noise / mean_noise : 1.0;
    const int rays = class_for(static_cast<float>(settings.rays_per_probe * share));
    if (spent + rays > ray_budget) break;
    spent += rays;
    chosen.emplace_back(candidates[i].probe, rays);
  }
  std::sort(chosen.begin(), chosen.end());
  Schedule schedule;
  for (const auto& [probe, rays] : chosen) {
    schedule.probes.push_back(probe);
    schedule.rays.push_back(rays);
  }
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

void learn_noise(float relative_square, float weight, ProbeRecord& record) {
  if (record.samples > 0.0f) {
    // A difference of two means has the sum of their variances
    const float one = relative_square / (1.0f / weight + 1.0f / record.samples);
    record.noise_samples = static_cast<std::uint16_t>(std::min(record.noise_samples + 1, 0xFFFF));
    const float share =
        std::max(1.0f / static_cast<float>(record.noise_samples), 1.0f / kNoiseMemory);
    record.noise = std::max(record.noise + share * (one - record.noise), kMinNoise);
  }
  record.samples += weight;
}

}  // namespace lambent
