// SPDX-License-Identifier: Apache-2.0
// What a recorded field keeps of its probes on the device, and the arguments of its own kernels.
// Lists are those of device_arguments.h.
#ifndef LAMBENT_FIELD_VULKAN_RECORDED_ARGUMENTS_H
#define LAMBENT_FIELD_VULKAN_RECORDED_ARGUMENTS_H

#include "field/placement/relocate_math.h"
#include "field/vulkan/device_records.h"
#include "lambent/shaders/ray_results.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

// What a probe is for.
const uint kProbeOn = 0u;
const uint kProbeOff = 1u;  ///< In solid matter.

/// What is known of a probe besides its tiles; at first all zero.
struct ProbeStanding {
  float samples;  ///< Updates that its tiles average.
  uint offset;    ///< Where it is to stand from its next rays on (encode_probe_offset).
  RelocationState relocation;
};
LAMBENT_DEVICE_ARRAY(StandingArray, ProbeStanding, 4)

/// Of all probes, by index.
struct ProbeStates {
  StandingArray standing;
  UintArray states;
};

/// A probe rests that is off, but for updates that look at all.
LAMBENT_FN bool probe_rests(uint state, uint all) {
  return state == kProbeOff && all == 0u;
}

/// Rays of a list's probes: count x rays_per_probe. Those of probes that rest have a mask of 0, and
/// so have those beyond the probes that the device chose.
struct RecordedRaysArguments {
  GridArray grids;
  ProbeStates probes;
  IntArray list;
  Vec3Array directions;
  RayArray rays;
  UintArray chosen;
  int count;
  int rays_per_probe;
  uint mask;
  uint all;
  uint is_chosen;
  uint unused;
};

/// Nearest hits through an engine's acceleration structure.
struct EngineClosestArguments {
  uvec2 structure;  ///< Its address, low word first.
  RayArray rays;
  HitArray hits;
  uint count;
  uint unused;
};

/// Has each probe's average count for this share of what it did.
struct FadeSamplesArguments {
  StandingArray standing;
  int count;
  float factor;
};

/// Counts an update in. `shares`: of the list's probes; 0 for those that rest.
struct RecordedBlendWeightsArguments {
  ProbeStates probes;
  UintArray offsets;  ///< Of the store: probes are now where their rays came from.
  IntArray list;
  FloatArray blend_weights;
  UintArray chosen;                ///< How many probes the list has where the device decided.
  UintArray largest_blend_weight;  ///< A word: becomes the largest one's bits.
  int count;
  uint is_chosen;  ///< 1: the device decided.
  float longest;   ///< Updates that an average remembers.
  uint all;
  uint discards_history;  ///< 1: what was averaged before counts for nothing.
};

/// Surfels from what an engine tells. `surfels`: of all probes x stride.
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

// Whether probes move: not at all; a step; the first one; or to where they stood best.
const uint kPlaceLeave = 0u;
const uint kPlaceStep = 1u;
const uint kPlaceFirstStep = 2u;
const uint kPlaceEnd = 3u;

/// Says what probes are for and where they are to stand, from what their rays saw.
struct MaintainArguments {
  GridArray grids;
  ProbeStates probes;
  IntArray list;
  RayArray rays;
  RayResultArray results;
  int count;
  int rays_per_probe;
  uint place;
  uint all;
};

// Sights that a probe is placed by at most; of more rays every second, third, ... is taken.
const int kMaxPlacementRays = 256;

LAMBENT_END
#endif
