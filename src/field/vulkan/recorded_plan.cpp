// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/recorded_plan.h"

#include <algorithm>
#include <cassert>
#include <set>

#include "field/schedule/schedule.h"
#include "field/transport/blend_math.h"
#include "field/vulkan/device_arguments.h"
#include "field/vulkan/recorded_arguments.h"

namespace lambent::vulkan {
namespace {

// Where a round takes several updates, probes in the first rounds receive light from probes that
// hold no light yet, or only part of its bounces. The light of these rounds is not averaged.
constexpr int kWarmUpRounds = 2;

// Probes inside geometry are traced once in this many rounds.
constexpr int kLookRounds = 8;

// Under a budget, one in this many updates also traces probes inside geometry that have waited for
// kMaxProbeAge.
constexpr std::uint32_t kLookUpdates = 16;

// Probes of coarser cascades than this are updated as often as those of this level, so that the
// last rays of all probes come from few updates.
constexpr int kMaxPeriodLevel = 5;

// The number of ray sets besides those of the last 2^level updates, since recycled probes also draw
// new ray sets in updates that follow edits.
constexpr int kRecycledSets = 8;

// Probes are placed again this many updates after static geometry was rebuilt last. Otherwise an
// object that moves in every frame, but is not marked as dynamic, would relocate probes in every
// frame.
constexpr std::uint32_t kRestUpdates = 8;

// The largest value of Known::traced, above kMaxPlacingUpdates of recorded_field.cpp.
constexpr int kMaxTracedCount = 255;

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
  const bool all_at_once = recorded.rays_per_update == 0 && recorded.probes_per_update == 0;
  follows_edits_ = all_at_once && !counts_bounces_;
  const int coarsest = std::min(settings.cascades - 1, kMaxPeriodLevel);
  most_sets_ = follows_edits_ && settings.cascades > 0 ? (1 << coarsest) + kRecycledSets : 1;
  for (const std::uint8_t level : levels) {
    known_.push_back({static_cast<std::uint8_t>(std::min<int>(level, kMaxPeriodLevel))});
  }
}

void BatchPlan::start_from(std::uint32_t updates, std::span<const ProbeStatus> statuses) {
  assert(statuses.size() == known_.size());
  updates_ = updates;
  // The rounds that warm up the field and those that place probes are over
  round_ = kWarmUpRounds;
  placing_since_ = round_ - placing_updates_;
  for (int probe = 0; probe < probes(); ++probe) {
    Known& known = known_[probe];
    known.traced = kMaxTracedCount;
    known.least_samples = std::min(statuses[probe].samples, longest_);
    known.of_file = known.least_samples > 0.0f;
    const bool traceable = statuses[probe].state != ProbeState::off;
    if (traceable && !known.of_file) recycled_.push_back(probe);
  }
}

bool BatchPlan::warming_up() const {
  return most_ < probes() && round_ < kWarmUpRounds;
}

bool BatchPlan::rounds_are_over() const {
  return next_ == 0 && !warming_up() && round_ - placing_since_ >= placing_updates_;
}

/// Whether a probe is updated in this round. Probes of level L are updated in every 2^L-th round,
/// and in every round while they are being placed.
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

/// Restarts all averages and the rounds, as at the start of the field.
void BatchPlan::begin_anew() {
  placing_since_ -= round_;
  round_ = next_ = 0;
  for (Known& known : known_) {
    known.least_samples = 0.0f;
    known.traced = 0;
  }
}

/// Whether one update can trace the last rays of all probes again, and new rays for probes that
/// have none.
bool BatchPlan::can_retrace() const {
  if (!follows_edits_ || updates_ == 0) return false;
  std::set<std::uint32_t> drawn_in;
  for (const Known& known : known_) {
    if (known.of_file) return false;
    drawn_in.insert(known.drawn_in);
  }
  return static_cast<int>(drawn_in.size()) <= most_sets_;
}

/// Notes updates that rebuild static geometry, after which probes are placed again.
void BatchPlan::note_rebuilt(const UpdatePlan& update) {
  for (const WorldChanges& change : update.changes) {
    if (change.rebuilt.empty()) continue;
    rebuilt_ = true;
    rebuilt_in_ = updates_;
  }
}

/// Plans an update after edits, in which all probes trace their last rays again. Probes that have
/// none draw new ones.
ProbeBatch BatchPlan::retrace() {
  ProbeBatch batch;
  batch.update = updates_++;
  batch.retraces = true;
  batch.all = true;
  recycled_.clear();
  for (int probe = 0; probe < probes(); ++probe) {
    Known& known = known_[probe];
    if (known.drawn_in == 0) known.drawn_in = batch.update + 1;
    batch.places = batch.places || known.traced < placing_updates_;
    known.traced = static_cast<std::uint8_t>(std::min(known.traced + 1, kMaxTracedCount));
    known.least_samples = std::min(known.least_samples, 1.0f);
    batch.probes.push_back(probe);
  }
  // Probes of one ray set are consecutive
  std::stable_sort(batch.probes.begin(), batch.probes.end(),
                   [&](int a, int b) { return known_[a].drawn_in < known_[b].drawn_in; });
  for (const int probe : batch.probes) {
    const std::uint32_t drawn_in = known_[probe].drawn_in - 1;
    if (batch.drawn_in.empty() || batch.drawn_in.back() != drawn_in) {
      batch.drawn_in.push_back(drawn_in);
    }
    batch.ray_sets.push_back(static_cast<int>(batch.drawn_in.size()) - 1);
  }
  assert(static_cast<int>(batch.drawn_in.size()) <= most_sets_);
  batch.count = static_cast<int>(batch.probes.size());
  return batch;
}

ProbeBatch BatchPlan::next_of_device() {
  ProbeBatch batch;
  batch.count = most_;
  batch.update = updates_;
  batch.on_device = true;
  batch.drawn_in = {updates_};
  batch.all = updates_ % kLookUpdates == 0;
  batch.places = recycles_ && placing_updates_ > 0;
  ++updates_;
  // From now on, only the device counts samples
  for (Known& known : known_) known.least_samples = 0.0f;
  recycled_.clear();
  return batch;
}

/// Chooses the probes of a batch: recycled ones first, then the next ones of the round.
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
    // It may be that none of the last probes of a round takes part in it
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
  // Sort the probes, so that memory is read in order
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
    known.traced = static_cast<std::uint8_t>(std::min(known.traced + 1, kMaxTracedCount));
    known.least_samples = may_move ? 0.0f : std::min(known.least_samples + 1.0f, longest_);
    known.chosen = false;
    known.of_file = false;
    known.drawn_in = batch.update + 1;
  }
  batch.drawn_in = {batch.update};
  batch.ray_sets.assign(batch.probes.size(), 0);
  batch.largest_blend_weight = history_blend_weight(least, 1.0f, longest_);
}

ProbeBatch BatchPlan::next(const UpdatePlan& update, std::span<const int> recycled) {
  const bool edited = std::any_of(update.changes.begin(), update.changes.end(),
                                  [](const WorldChanges& change) { return change.any(); });
  note_rebuilt(update);
  const bool at_rest = rebuilt_ && updates_ - rebuilt_in_ >= kRestUpdates;
  const bool place_again = update.place_again || at_rest;
  if (place_again) begin_placement();
  if (at_rest) rebuilt_ = false;
  recycles_ = recycles_ || !recycled.empty();
  if (follows_edits_) {
    for (const int probe : recycled) {
      known_[probe].drawn_in = 0;
      known_[probe].of_file = false;
    }
  }
  const bool retraces = edited && can_retrace();
  // Averages can be preserved over an edit only by tracing the last rays of all probes again
  const bool anew = edited && !retraces;
  if (anew) begin_anew();
  ProbeBatch batch;
  if (budget_ && rounds_are_over()) {
    batch = next_of_device();
  } else {
    for (const int probe : recycled) {
      known_[probe].traced = 0;
      known_[probe].least_samples = 0.0f;
    }
    for (Known& known : known_) known.least_samples *= update.history;
    if (retraces) {
      batch = retrace();
    } else {
      recycled_.insert(recycled_.end(), recycled.begin(), recycled.end());
      batch = next_in_round();
      batch.discards_history = batch.discards_history || anew;
    }
  }
  batch.history = update.history;
  batch.place_again = place_again;
  return batch;
}

/// Plans the next update of a round.
ProbeBatch BatchPlan::next_in_round() {
  ProbeBatch batch;
  batch.update = updates_++;
  choose(batch);
  count_samples(batch);
  if (next_ == probes()) {
    next_ = 0;
    ++round_;
  }
  return batch;
}

}  // namespace lambent::vulkan
