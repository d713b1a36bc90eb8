// SPDX-License-Identifier: Apache-2.0
// The arguments of reset_probes.
#ifndef LAMBENT_FIELD_PLACEMENT_RESET_ARGUMENTS_H
#define LAMBENT_FIELD_PLACEMENT_RESET_ARGUMENTS_H

#include "field/schedule/schedule_arguments.h"

LAMBENT_BEGIN

/// Arguments of reset_probes, which resets all data of the probes of a list in a recorded field:
/// their light, distances, offset, state, history and variability.
struct ResetProbesArguments {
  ProbeStates probes;
  VariabilityArray variability;
  IntArray list;
  UintArray offsets;
  UintArray distance;
  Vec4Array light;
  Vec4Array last_irradiance_estimate;
  int count;
  int distance_words;    ///< Words of a probe's distance tile.
  uint has_variability;  ///< 0: the host schedules, and there is no `variability`.
  uint unused;
};

LAMBENT_END
#endif
