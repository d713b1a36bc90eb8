// SPDX-License-Identifier: Apache-2.0
// Based on: Talbot, Cline and Egbert, "Importance Resampling for Global Illumination", EGSR 2005.
// Resampled importance sampling of one out of a stream of candidates, with one random number for
// all of its choices.
#ifndef LAMBENT_SHARED_RESERVOIR_H
#define LAMBENT_SHARED_RESERVOIR_H

#include "shared/random.h"

LAMBENT_BEGIN

struct Reservoir {
  float chosen_target;  ///< Target function of the candidate that was chosen last.
  float sum;            ///< Sum of the targets so far.
  float u;              ///< Uniform number that decides the next choice.
};

LAMBENT_FN Reservoir begin_reservoir(float u) {
  Reservoir reservoir = {0.0f, 0.0f, u};
  return reservoir;
}

/// Offers a candidate, and tells whether it replaces the chosen one: with a probability in
/// proportion to its target.
LAMBENT_FN bool accepts(LAMBENT_INOUT(Reservoir) reservoir, float target) {
  if (!(target > 0.0f)) return false;
  reservoir.sum += target;
  float share = target / reservoir.sum;
  bool accepted = reservoir.u < share;
  float rescaled = accepted ? reservoir.u / share : (reservoir.u - share) / (1.0f - share);
  reservoir.u = min(rescaled, kLargestUniform);
  if (accepted) reservoir.chosen_target = target;
  return accepted;
}

/// Weight with which the chosen candidate's expected light is that of all candidates together; 0
/// where none was chosen.
LAMBENT_FN float resampling_weight(Reservoir reservoir) {
  return reservoir.sum > 0.0f ? reservoir.sum / reservoir.chosen_target : 0.0f;
}

LAMBENT_END
#endif
