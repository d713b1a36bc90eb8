// SPDX-License-Identifier: Apache-2.0
// The arguments of the kernels that apply edits to a recorded field. Arrays "of the list" have the
// texels of the probes that are traced again, in the order of the list.
#ifndef LAMBENT_FIELD_EDITS_EDIT_ARGUMENTS_H
#define LAMBENT_FIELD_EDITS_EDIT_ARGUMENTS_H

#include "field/vulkan/device_arguments.h"
#include "field/vulkan/recorded_arguments.h"

LAMBENT_BEGIN

/// MoveDistancesArguments::blocked_before of a probe without history, whose stored distances are
/// replaced by the new ones, like those of a probe that came out of geometry.
const uint kNoDistancesBefore = 1u;

/// Arguments of gather_tiles, which copies tiles of a list out of the arrays of all probes.
struct GatherTilesArguments {
  IntArray probes;
  Vec4Array light;          ///< Of all probes.
  Vec4Array last_estimate;  ///< Of all probes.
  Vec4Array light_before;   ///< Of the list.
  Vec4Array estimate;       ///< Of the list.
  int count;
  int unused;
};

/// Arguments of history_ratio, which computes the history ratios of a list. `estimate` holds the
/// light that the last rays estimate from the current light of all probes. It replaces the last
/// estimate of probes that were traced with new rays since the last edit.
struct HistoryRatioArguments {
  ProbeStates probes;
  IntArray list;
  Vec4Array last_estimate;  ///< Of all probes.
  Vec4Array light_before;
  Vec4Array estimate;
  Vec4Array history_ratio;
  UintArray blocked_before;
  int count;
  int unused;
};

// The steps of scale_light.
const uint kSumLight = 0u;  ///< One workgroup computes `mean`.
/// Scales the list's light by the growth of direct light, and reduces history ratios, one lane
/// per probe.
const uint kScaleLight = 1u;

// The lanes of scale_light's workgroups.
const int kSumLightLanes = 256;

/// Arguments of scale_light, which gives a solve after an edit a good start.
struct ScaleLightArguments {
  IntArray list;
  Vec4Array light;            ///< Of all probes.
  EditedLightArray edited;    ///< Of the list's probes.
  Vec3Array mean;             ///< One ProbeAtEdit, the mean of the list's.
  Vec4Array history_ratio;    ///< Of the list.
  FloatArray history_shares;  ///< history_share() of each of the list's probes.
  int count;
  uint step;
};

/// Arguments of keep_unchanged, which restores the light of those probes of a list that an edit did
/// not change visibly, and reduces the numbers of samples of the others.
struct KeepUnchangedArguments {
  ProbeStates probes;
  IntArray list;
  Vec4Array light;          ///< Of all probes.
  Vec4Array last_estimate;  ///< Of all probes.
  Vec4Array light_before;
  Vec4Array solution;
  Vec4Array history_ratio;
  FloatArray history_shares;  ///< history_share() of each of the list's probes.
  EditedLightArray edited;    ///< Of the list's probes.
  UintArray changed;  ///< One word per probe of the list: 1 where its light changed, else 0.
  int count;
  int unused;
};

LAMBENT_END
#endif
