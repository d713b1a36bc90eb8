// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/recorded_plan.h"

#include <algorithm>

#include "field/schedule/schedule.h"
#include "field/vulkan/device_arguments.h"
#include "field/vulkan/recorded_arguments.h"

namespace lambent::vulkan {
namespace {

// In the first rounds of several turns, probes see others that know no light yet, or a part of its
// bounces: what they learn then is not averaged in.
constexpr int kBlindRounds = 2;

// Probes in solid matter are looked at once in so many rounds.
constexpr int kLookRounds = 8;

// Under a budget, in every so many updates probes in solid matter are looked at that were not for
// as long as a probe waits at most.
constexpr std::uint32_t kLookUpdates = 16;

int most_probes_of(const FieldSettings& settings, const RecordedFieldSettings& recorded,
                   int probes) {
  if (recorded.rays_per_update > 0) {
    const int most =
        std::min({recorded.rays_per_update / settings.rays_per_probe, probes, kMostProbes});
    return most / kBlockProbes * kBlockProbes;
  }
  return recorded.probes_per_update > 0 ? std::min(recorded.probes_per_update, probes) : probes;
}

}  // namespace

TurnPlan::TurnPlan(const FieldSettings& settings, const RecordedFieldSettings& recorded, int probes)
    : probes_(probes),
      most_(most_probes_of(settings, recorded, probes)),
      budget_(recorded.rays_per_update > 0),
      placing_rounds_(settings.relocation ? recorded.placing_updates : 0),
      longest_(longest_average(settings)) {}

std::uint32_t TurnPlan::place_in_round() const {
  const int placing = round_ - placing_since_;
  if (placing >= placing_rounds_) return kPlaceLeave;
  if (placing == 0) return kPlaceFirstStep;
  return placing + 1 == placing_rounds_ ? kPlaceEnd : kPlaceStep;
}

void TurnPlan::begin_round() {
  if (place_again_) placing_since_ = round_;
  place_again_ = false;
}

bool TurnPlan::rounds_are_over() const {
  const bool blind = most_ < probes_ && round_ < kBlindRounds;
  return next_ == 0 && !place_again_ && !blind && place_in_round() == kPlaceLeave;
}

Turn TurnPlan::next_of_device(const UpdatePlan& update) {
  Turn turn;
  turn.count = most_;
  turn.update = updates_;
  turn.history = update.history;
  turn.on_device = true;
  turn.all = updates_ % kLookUpdates == 0;
  turn.place = kPlaceLeave;
  ++updates_;
  return turn;
}

Turn TurnPlan::next(const UpdatePlan& update) {
  place_again_ = place_again_ || update.place_again;
  if (budget_ && rounds_are_over()) {
    least_samples_ = 0.0f;  // the device knows
    return next_of_device(update);
  }
  if (next_ == 0) begin_round();
  least_samples_ *= update.history;

  Turn turn;
  turn.first = next_;
  turn.count = std::min(most_, probes_ - next_);
  turn.update = updates_;
  turn.history = update.history;
  turn.starts_anew = most_ < probes_ && round_ < kBlindRounds;
  turn.place = place_in_round();
  turn.all = turn.place != kPlaceLeave || round_ % kLookRounds == 0;
  if (turn.starts_anew) least_samples_ = 0.0f;
  turn.largest_share = 1.0f / (std::min(least_samples_, longest_ - 1.0f) + 1.0f);

  ++updates_;
  next_ += turn.count;
  if (next_ == probes_) {
    next_ = 0;
    ++round_;
    least_samples_ = turn.place != kPlaceLeave ? 0.0f : std::min(least_samples_ + 1.0f, longest_);
  }
  return turn;
}

}  // namespace lambent::vulkan
