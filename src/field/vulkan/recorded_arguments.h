// SPDX-License-Identifier: Apache-2.0
// The state of a recorded field's probes on the device, and the arguments of the kernels that only
// recorded fields run. For lists of probes, see device_arguments.h.
#ifndef LAMBENT_FIELD_VULKAN_RECORDED_ARGUMENTS_H
#define LAMBENT_FIELD_VULKAN_RECORDED_ARGUMENTS_H

#include "field/placement/relocate_math.h"
#include "field/vulkan/device_records.h"
#include "lambent/shaders/ray_results.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

// States of a probe of a recorded field.
const uint kProbeOn = 0u;
const uint kProbeOff = 1u;  ///< It stands inside geometry.

/// The history and placement of a probe. All zero at first.
struct RecordedProbe {
  float samples;  ///< Number of updates that its tiles average.
  uint offset;    ///< Offset that applies from its next rays on (encode_probe_offset).
  RelocationState relocation;
  uint placed;  ///< Number of updates that took part in its placement so far.
  uint coarse;  ///< 1: its last estimate is coarse, since new rays were traced after the last edit.
};
LAMBENT_DEVICE_ARRAY(StandingArray, RecordedProbe, 4)

/// Arrays with one entry per probe of the field.
struct ProbeStates {
  StandingArray standing;
  UintArray states;
};

/// Whether a probe is left out of an update: it is off, its placement of `placing_updates` updates
/// is over, and the update does not trace `all` probes.
LAMBENT_FN bool probe_is_skipped(uint state, uint placed, uint placing_updates, uint all) {
  return state == kProbeOff && placed >= placing_updates && all == 0u;
}

/// Whether a probe's light and distances are averages, which edits preserve in part.
LAMBENT_FN bool has_history(uint state, float samples) {
  return state == kProbeOn && samples > 0.0f;
}

/// Arguments of recorded_rays, which makes count x rays_per_probe rays. Rays of probes that are
/// left out, and rays beyond the probes that the device chose, get a mask of 0.
struct RecordedRaysArguments {
  GridArray grids;
  ProbeStates probes;
  ProbeList list;
  RayArray rays;
  UintArray chosen;
  int count;
  int rays_per_probe;
  uint mask;
  uint all;
  uint is_chosen;
  uint placing_updates;
};

/// Arguments of fade_samples, which multiplies every probe's number of samples by a factor.
struct FadeSamplesArguments {
  StandingArray standing;
  int count;
  float factor;
  uint place_again;  ///< 1: the placement of every probe begins again.
  uint unused;
};

// What an update does with the earlier samples of its probes: it adds new ones to them; it discards
// them; or it has traced the probes' last rays again after an edit, which adds no samples.
const uint kHistoryGrows = 0u;
const uint kHistoryDiscarded = 1u;
const uint kHistoryRetraced = 2u;

/// Arguments of recorded_blend_weights, which counts an update's samples. `blend_weights` has one
/// number per probe of the list, 0 for probes that are left out.
struct RecordedBlendWeightsArguments {
  ProbeStates probes;
  UintArray offsets;  ///< The store's offsets, which become those that the rays started from.
  IntArray list;
  FloatArray blend_weights;
  UintArray chosen;                ///< One word: the list's length where the device decides it.
  UintArray largest_blend_weight;  ///< One word: receives the bits of the largest blend weight.
  int count;
  uint is_chosen;  ///< 1: the device decides the list's length.
  float longest;   ///< The most updates that an average remembers.
  uint all;        ///< 1: probes that are off are traced, too.
  uint history;    ///< kHistoryGrows, kHistoryDiscarded or kHistoryRetraced.
  uint placing_updates;
};

/// Arguments of recorded_surfels, which makes surfels from an engine's ray results. `surfels` has
/// `stride` entries for every probe of the field.
struct RecordedSurfelsArguments {
  IntArray list;
  RayArray rays;
  RayResultArray results;
  SurfelArray surfels;
  int count;
  int rays_per_probe;
  int stride;
  float max_albedo;
};

// What an update does to the place of a probe: nothing, one step of its relocation, the first step,
// or the end of its relocation, which moves the probe to the best place found.
const uint kPlaceLeave = 0u;
const uint kPlaceStep = 1u;
const uint kPlaceFirstStep = 2u;
const uint kPlaceEnd = 3u;

/// What the next update of a probe does to its place, after `placed` of the `placing_updates` that
/// its placement takes.
LAMBENT_FN uint placing_step(uint placed, uint placing_updates) {
  if (placed >= placing_updates) return kPlaceLeave;
  if (placed == 0u) return kPlaceFirstStep;
  return placed + 1u == placing_updates ? kPlaceEnd : kPlaceStep;
}

/// Arguments of maintain_probes, which sets the states and next places of probes from their rays.
struct MaintainArguments {
  GridArray grids;
  ProbeStates probes;
  IntArray list;
  RayArray rays;
  RayResultArray results;
  int count;
  int rays_per_probe;
  uint placing_updates;
  uint all;
};

// Relocation uses at most this many of a probe's rays. Where there are more, it uses every second,
// third, and so on.
const int kMaxPlacementRays = 256;

LAMBENT_END
#endif
