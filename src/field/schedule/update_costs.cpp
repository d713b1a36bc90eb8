// SPDX-License-Identifier: Apache-2.0
#include "field/schedule/update_costs.h"

#include <algorithm>
#include <limits>

#include "field/schedule/schedule.h"

namespace lambent {
namespace {

// The least share of a time that goes to work.
constexpr double kLeastWorkShare = 0.5;

// Weight of the newest measurement in a moving average.
constexpr double kNewestShare = 0.2;

// The assumed cost of a ray before any was timed [ms], as on a slow processor.
constexpr double kFirstGuessMs = 1e-3;

// Slices have at least this many probes: each slice has a cost of its own, about that of as many
// probes.
constexpr std::size_t kLeastSlice = 16;

// The assumed cost of a probe before any was timed [ms], as on a slow processor.
constexpr double kFirstProbeMs = 0.5;

/// How much of a time [ms] is left for work, where all else takes `other_ms`: at least
/// kLeastWorkShare of it, so that an update gets on even where all else takes longer than that.
double time_for_work(double ms, double other_ms) {
  return std::max(ms - other_ms, kLeastWorkShare * ms);
}

/// The whole part of a number, which may be infinite: at most what an int can count.
std::uint64_t whole_number(double number) {
  constexpr double kMost = std::numeric_limits<int>::max();
  return number > 0.0 ? static_cast<std::uint64_t>(std::min(number, kMost)) : 0;
}

}  // namespace

void MeasuredTime::learn(double ms) {
  ms_ = known_ ? ms_ + kNewestShare * (ms - ms_) : ms;
  known_ = true;
}

void RayCost::learn(std::uint64_t rays, double rays_ms, double other_ms) {
  if (rays == 0) return;
  const bool measured = rays_ms > 0.0;
  ray_.learn((measured ? rays_ms : other_ms) / static_cast<double>(rays));
  other_.learn(measured ? std::max(other_ms, 0.0) : 0.0);
}

std::uint64_t RayCost::rays_within(double ms, double spent_ms) const {
  const double cost = ray_.ms() > 0.0 ? ray_.ms() : kFirstGuessMs;
  const double rays = time_for_work(ms, spent_ms + other_.ms()) / cost;
  return std::max(static_cast<std::uint64_t>(kRayClasses.front()), whole_number(rays));
}

void EditCost::learn_slice(std::size_t probes, double ms) {
  if (probes > 0) ms_per_probe_ = ms / static_cast<double>(probes);
}

double EditCost::time_left(double ms, double spent_ms) const {
  return time_for_work(ms, spent_ms + other_.ms());
}

std::size_t EditCost::probes_within(double ms) const {
  const double cost = ms_per_probe_ > 0.0 ? ms_per_probe_ : kFirstProbeMs;
  return std::max(kLeastSlice, static_cast<std::size_t>(whole_number(ms / cost)));
}

}  // namespace lambent
