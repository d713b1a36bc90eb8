// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/recorded_plan.h"

#include <algorithm>

#include "field/schedule/schedule.h"
#include "field/vulkan/device_arguments.h"
#include "field/vulkan/recorded_arguments.h"

namespace lambent::vulkan {
namespace {

// Where a round takes several updates, the probes of the first rounds receive light from probes
// that hold none yet, or a part of its bounces only. What they receive in these rounds is not
// averaged.
constexpr int kWarmUpRounds = 2;

// Probes inside geometry are traced once in this many rounds.
constexpr int kLookRounds = 8;

// Under a budget, one in this many updates also traces probes inside geometry that have waited for
// kMaxProbeAge.
constexpr std::uint32_t kLookUpdates = 16;

// Counts of a probe's updates end here: above kMaxPlacingUpdates of recorded_field.cpp.
constexpr int kOften = 255;

int most_probes_of(const FieldSettings& settings, const RecordedFieldSettings& recorded,
                   int probes) {
  if (recorded.rays_per_update > 0) {
    const int most =
        std::min({recorded.rays_per_update / settings.rays_per_probe, probes, kMaxBatchProbes});
    return most / kBlockProbes * kBlockProbes;
  }
  return recorded.probes_per_update > 0 ? std::min(recorded.probes_per_update, probes) : probes;
}

}  // namespace

BatchPlan::BatchPlan(const FieldSettings& settings, const RecordedFieldSettings& recorded,
                     std::vector<std::uint8_t> levels)
    : most_(most_probes_of(settings, recorded, static_cast<int>(levels.size()))),
      budget_(recorded.rays_per_update > 0),
      counts_bounces_(settings.max_bounces >= 0),
      placing_updates_(settings.relocation ? recorded.placing_updates : 0),
      longest_(longest_average(settings)) {
  for (const std::uint8_t level : levels) known_.push_back({level});
}

bool BatchPlan::warming_up() const {
  return most_ < probes() && round_ < kWarmUpRounds;
}

bool BatchPlan::rounds_are_over() const {
  return next_ == 0 && !warming_up() && round_ - placing_since_ >= placing_updates_;
}

/// Whether a probe is updated in this round: those of level L are in every 2^L-th, and in as many
/// as their placement takes.
bool BatchPlan::takes_part(int probe) const {
  const Known& known = known_[probe];
  if (known.level == 0 || counts_bounces_ || warming_up()) return true;
  if (known.traced < std::max(placing_updates_, 1)) return true;
  return (round_ + probe) % (1 << known.level) == 0;
}

void BatchPlan::begin_placement() {
  placing_since_ = next_ == 0 ? round_ : round_ + 1;
  for (Known& known : known_) known.traced = 0;
}

ProbeBatch BatchPlan::next_of_device(const UpdatePlan& update) {
  ProbeBatch batch;
  batch.count = most_;
  batch.update = updates_;
  batch.history = update.history;
  batch.on_device = true;
  batch.all = updates_ % kLookUpdates == 0;
  batch.places = recycles_ && placing_updates_ > 0;
  ++updates_;
  // From now on only the device knows
  for (Known& known : known_) known.least_samples = 0.0f;
  recycled_.clear();
  return batch;
}

/// Chooses the probes of a batch: recycled ones first, then those whose turn it is.
void BatchPlan::choose(ProbeBatch& batch) {
  const auto room = [&] { return static_cast<int>(batch.probes.size()) < most_; };
  const auto add = [&](int probe) {
    if (known_[probe].chosen) return;
    known_[probe].chosen = true;
    batch.probes.push_back(probe);
  };
  std::size_t served = 0;
  while (room() && served < recycled_.size()) add(recycled_[served++]);
  recycled_.erase(recycled_.begin(), recycled_.begin() + static_cast<std::ptrdiff_t>(served));
  do {
    // A round may end with probes none of which takes part in it
    if (next_ == probes()) {
      next_ = 0;
      ++round_;
    }
    batch.discards_history = warming_up();
    batch.all = round_ % kLookRounds == 0;
    for (; room() && next_ < probes(); ++next_) {
      if (takes_part(next_)) add(next_);
    }
  } while (batch.probes.empty());
  // Consecutive probes are consecutive in memory
  std::sort(batch.probes.begin(), batch.probes.end());
  batch.count = static_cast<int>(batch.probes.size());
}

/// Counts the samples of a batch's probes, and bounds their blend weights.
void BatchPlan::count_samples(ProbeBatch& batch) {
  float least = longest_;
  for (const int probe : batch.probes) {
    Known& known = known_[probe];
    if (batch.discards_history) known.least_samples = 0.0f;
    least = std::min(least, known.least_samples);
    const bool may_move = known.traced < placing_updates_;
    batch.places = batch.places || may_move;
    known.traced = static_cast<std::uint8_t>(std::min(known.traced + 1, kOften));
    known.least_samples = may_move ? 0.0f : std::min(known.least_samples + 1.0f, longest_);
    known.chosen = false;
  }
  batch.largest_blend_weight = history_blend_weight(least, 1.0f, longest_);
}

ProbeBatch BatchPlan::next(const UpdatePlan& update, std::span<const int> recycled) {
  if (update.place_again) begin_placement();
  recycles_ = recycles_ || !recycled.empty();
  ProbeBatch batch;
  if (budget_ && rounds_are_over()) {
    batch = next_of_device(update);
  } else {
    for (const int probe : recycled) {
      known_[probe].traced = 0;
      known_[probe].least_samples = 0.0f;
    }
    recycled_.insert(recycled_.end(), recycled.begin(), recycled.end());
    if (update.history < 1.0f) {
      for (Known& known : known_) known.least_samples *= update.history;
    }
    batch.update = updates_++;
    batch.history = update.history;
    choose(batch);
    count_samples(batch);
    if (next_ == probes()) {
      next_ = 0;
      ++round_;
    }
  }
  batch.place_again = update.place_again;
  return batch;
}

}  // namespace lambent::vulkan
