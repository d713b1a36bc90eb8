// SPDX-License-Identifier: Apache-2.0
// The schedule of a recorded field on its device: what it keeps, and the arguments of its kernels.
//
// Probes fall into bins by what serving them is worth. Those of the highest bins are served, and of
// the bin that the budget ends in the first, in the order of their indices: whole numbers alone
// decide, so that it is the same on every run. An update serves whole blocks of kBlockProbes, so
// that kernels of eight probes a group have none to leave out: it is filled up with the next ones.
#ifndef LAMBENT_FIELD_SCHEDULE_SCHEDULE_ARGUMENTS_H
#define LAMBENT_FIELD_SCHEDULE_SCHEDULE_ARGUMENTS_H

#include "field/schedule/schedule_math.h"
#include "field/vulkan/device_arguments.h"
#include "field/vulkan/recorded_arguments.h"

LAMBENT_BEGIN

// Bins: probes that take no part; that rest; by gain, so many an octave; by age; never served.
const int kNoPartBin = 0;
const int kRestBin = 1;
const int kFirstReductionBin = 2;
const int kReductionBins =
    96;  // from 2^-14 on, a settled probe's of the longest memory, up to 2^10
const int kFirstOldBin = 98;
const int kOldBins = 16;
const int kNeverBin = 114;
const int kPriorityBins = 115;

// What is left of a gain's bits: its exponent and two bits more.
const uint kReductionShift = 21u;
const int kMinReductionStep = (127 - 14) << 2;

/// The bin of a probe that takes part. Updates are counted from 1; served by 0: never.
LAMBENT_FN int priority_bin(float reduction, uint served, uint update) {
  if (served == 0u) return kNeverBin;
  if (waits_too_long(served, update)) {
    return kFirstOldBin + min(int((update - served) / kMaxProbeAge) - 1, kOldBins - 1);
  }
  if (reduction <= 0.0f) return kRestBin;
  int octaves = int(floatBitsToUint(reduction) >> kReductionShift) - kMinReductionStep;
  return kFirstReductionBin + clamp(octaves, 0, kReductionBins - 1);
}

/// What is known of a probe besides its standing.
struct ProbeService {
  KnownNoise known;
  uint served;  ///< Number of the update that traced it last, counted from 1; 0: none.
};
LAMBENT_DEVICE_ARRAY(ServiceArray, ProbeService, 4)

/// What the device decided of an update, and what it remembers for the next one.
struct ScheduleState {
  ListState list;
  uint live;         ///< Probes that take part.
  float mean_light;  ///< Luminance of all of them.
  float mean_noise;  ///< Of those that did not rest in the update before.
  int last_bin;      ///< That the budget ended in, ...
  int of_last_bin;   ///< ... and so many of it were served.
};
LAMBENT_DEVICE_ARRAY(ScheduleStateArray, ScheduleState, 4)

// Probes of a chunk, a workgroup's: all devices that trace rays have groups of so many lanes.
const int kChunkProbes = 256;

/// Probes that follow one another.
struct ScheduleChunk {
  uint bins[kPriorityBins];  ///< How many are in each bin.
  float noise_sum;           ///< Of those that do not rest, ...
  uint unsettled;            ///< ... so many.
  int higher;                ///< How many are in higher bins than the last that is served, ...
  int of_last;               ///< ... and in the last.
};
LAMBENT_DEVICE_ARRAY(ChunkArray, ScheduleChunk, 4)
LAMBENT_DEVICE_ARRAY(ListSizeArray, ListSize, 4)

/// Bins of all probes, and how many chunks have of each.
struct SchedulePriorityArguments {
  GridArray grids;
  ProbeStates probes;
  ServiceArray service;
  ScheduleStateArray state;
  UintArray bins;
  ChunkArray chunks;
  int count;
  uint update;    ///< Counted from 1.
  float longest;  ///< Updates that an average remembers.
  uint look;      ///< 1: probes that are off are looked at where they have waited too long.
};

/// How many are served, and what that makes of the kernels to come.
struct ScheduleChooseArguments {
  ScheduleStateArray state;
  ChunkArray chunks;
  ProbeBlockArray blocks;
  ListSizeArray sizes;
  int chunk_count;
  int most;  ///< Probes that may be served: whole blocks.
};

/// Lists them.
struct ScheduleListArguments {
  ScheduleStateArray state;
  ChunkArray chunks;
  UintArray bins;
  IntArray list;
  int count;
};

/// Books an update's probes. `changes`: of the list's probes, as compare_light finds them where
/// none is too dark.
struct UpdateVariabilityArguments {
  ScheduleStateArray state;
  ServiceArray service;
  IntArray list;
  FloatArray blend_weights;
  Vec3Array changes;
  int count;
  uint chosen;  ///< 1: the list is as long as the device decided.
  uint update;  ///< Counted from 1.
  uint unused;
};

/// What remains for the next update: the mean noise and the mean light.
struct ScheduleMeansArguments {
  ScheduleStateArray state;
  ChunkArray chunks;
  FloatArray blend_weights;
  Vec3Array changes;
  int chunk_count;
  int count;
  uint chosen;
  uint unused;
};

LAMBENT_END
#endif
