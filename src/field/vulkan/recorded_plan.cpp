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
                     int probes)
    : probes_(probes),
      most_(most_probes_of(settings, recorded, probes)),
      budget_(recorded.rays_per_update > 0),
      placing_rounds_(settings.relocation ? recorded.placing_updates : 0),
      longest_(longest_average(settings)) {}

std::uint32_t BatchPlan::place_in_round() const {
  const int placing = round_ - placing_since_;
  if (placing >= placing_rounds_) return kPlaceLeave;
  if (placing == 0) return kPlaceFirstStep;
  return placing + 1 == placing_rounds_ ? kPlaceEnd : kPlaceStep;
}

void BatchPlan::begin_round() {
  if (place_again_) placing_since_ = round_;
  place_again_ = false;
}

bool BatchPlan::rounds_are_over() const {
  const bool warming_up = most_ < probes_ && round_ < kWarmUpRounds;
  return next_ == 0 && !place_again_ && !warming_up && place_in_round() == kPlaceLeave;
}

ProbeBatch BatchPlan::next_of_device(const UpdatePlan& update) {
  ProbeBatch batch;
  batch.count = most_;
  batch.update = updates_;
  batch.history = update.history;
  batch.on_device = true;
  batch.all = updates_ % kLookUpdates == 0;
  batch.place = kPlaceLeave;
  ++updates_;
  return batch;
}

ProbeBatch BatchPlan::next(const UpdatePlan& update) {
  place_again_ = place_again_ || update.place_again;
  if (budget_ && rounds_are_over()) {
    least_samples_ = 0.0f;  // from now on only the device knows
    return next_of_device(update);
  }
  if (next_ == 0) begin_round();
  least_samples_ *= update.history;

  ProbeBatch batch;
  batch.first = next_;
  batch.count = std::min(most_, probes_ - next_);
  batch.update = updates_;
  batch.history = update.history;
  batch.discards_history = most_ < probes_ && round_ < kWarmUpRounds;
  batch.place = place_in_round();
  batch.all = batch.place != kPlaceLeave || round_ % kLookRounds == 0;
  if (batch.discards_history) least_samples_ = 0.0f;
  batch.largest_blend_weight = history_blend_weight(least_samples_, 1.0f, longest_);

  ++updates_;
  next_ += batch.count;
  if (next_ == probes_) {
    next_ = 0;
    ++round_;
    least_samples_ = batch.place != kPlaceLeave ? 0.0f : std::min(least_samples_ + 1.0f, longest_);
  }
  return batch;
}

}  // namespace lambent::vulkan
