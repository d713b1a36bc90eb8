// SPDX-License-Identifier: Apache-2.0
// The schedule of a recorded field on its device: its data, and the arguments of its kernels.
//
// Probes are sorted into bins by their priority. An update traces the probes of the highest bins,
// and in the bin in which the budget ends those with the lowest indices. The choice depends on
// integers only, so that it is the same on every run. An update traces whole blocks of
// kBlockProbes, because kernels work on eight probes per group; the last block is filled up with
// the next probes.
#ifndef LAMBENT_FIELD_SCHEDULE_SCHEDULE_ARGUMENTS_H
#define LAMBENT_FIELD_SCHEDULE_SCHEDULE_ARGUMENTS_H

#include "field/schedule/schedule_math.h"
#include "field/vulkan/device_arguments.h"
#include "field/vulkan/recorded_arguments.h"

LAMBENT_BEGIN

// The bins, in ascending priority: probes that are left out; converged ones; bins by error
// reduction, four per octave; bins by age; probes that were never traced. The bins by error
// reduction reach from 2^-14, below the reduction at which a probe with the longest memory
// converges, to 2^10.
const int kInactiveBin = 0;
const int kConvergedBin = 1;
const int kFirstReductionBin = 2;
const int kReductionBins = 96;
const int kFirstOldBin = 98;
const int kOldBins = 16;
const int kNeverBin = 114;
const int kPriorityBins = 115;

// Shifts a float's bits so that its exponent and two bits of its mantissa remain: four bins per
// octave.
const uint kReductionShift = 21u;
const int kMinReductionStep = (127 - 14) << 2;

/// The bin of a probe that is not left out, by its probe_urgency(). Never decreases with the
/// urgency.
LAMBENT_FN int priority_bin(float urgency) {
  if (urgency >= kNeverUrgency) return kNeverBin;
  if (urgency >= kOldUrgency) {
    // The urgency of probes that wait too long exceeds kOldUrgency by 0.5 to 1
    int old = int((urgency - kOldUrgency - 0.5f) * (2.0f * float(kOldBins)));
    return kFirstOldBin + clamp(old, 0, kOldBins - 1);
  }
  if (urgency <= 0.0f) return kConvergedBin;
  float reduction = urgency / (kOldUrgency - urgency);
  int octaves = int(floatBitsToUint(reduction) >> kReductionShift) - kMinReductionStep;
  return kFirstReductionBin + clamp(octaves, 0, kReductionBins - 1);
}

/// The variance of the light of a probe, and when it was traced.
struct ProbeVariability {
  VarianceEstimate known;
  uint last_traced;  ///< Number of the update that traced it last, counted from 1; 0: none.
};
LAMBENT_DEVICE_ARRAY(VariabilityArray, ProbeVariability, 4)

/// The variability of a probe that was never traced, with the initial values of ProbeStatus.
LAMBENT_FN ProbeVariability new_variability() {
  ProbeVariability variability = {{1.0f, 0u}, 0u};
  return variability;
}

/// The device's decision about an update, and the state that the next one starts from.
struct ScheduleState {
  ListState list;
  uint live;             ///< The number of probes that are not left out.
  float mean_light;      ///< Mean luminance of the probes that are not left out.
  float mean_deviation;  ///< Mean deviation of the probes that had not converged before the update.
  int last_bin;          ///< The bin in which the budget ends.
  int of_last_bin;       ///< The number of probes of `last_bin` that are traced.
};
LAMBENT_DEVICE_ARRAY(ScheduleStateArray, ScheduleState, 4)

// The number of probes of a chunk, and the size of the workgroup that works on it. All devices with
// ray tracing support this size.
const int kChunkProbes = 256;

/// Sums over consecutive probes.
struct ScheduleChunk {
  uint bins[kPriorityBins];  ///< The number of probes in each bin.
  float deviation_sum;       ///< Sum of the deviations of the probes that have not converged.
  uint unsettled;            ///< The number of probes that have not converged.
  int higher;   ///< The number of probes in higher bins than the last one that is traced.
  int of_last;  ///< The number of probes in the last bin that is traced.
};
LAMBENT_DEVICE_ARRAY(ChunkArray, ScheduleChunk, 4)
LAMBENT_DEVICE_ARRAY(ListSizeArray, ListSize, 4)

/// Arguments of schedule_priority, which sorts all probes into bins and counts them per chunk.
struct SchedulePriorityArguments {
  GridArray grids;
  IntArray levels;  ///< The cascade level of each volume.
  ProbeStates probes;
  VariabilityArray variability;
  ScheduleStateArray state;
  UintArray bins;
  ChunkArray chunks;
  int count;
  uint update;    ///< Number of the update, counted from 1.
  float longest;  ///< The most updates that an average remembers.
  uint look;      ///< 1: probes that are off are traced as well if they waited for kMaxProbeAge.
};

/// Arguments of schedule_choose, which decides how many probes are traced, and sizes the kernels
/// that work on them.
struct ScheduleChooseArguments {
  ScheduleStateArray state;
  ChunkArray chunks;
  ProbeBlockArray blocks;
  ListSizeArray sizes;
  int chunk_count;
  int most;  ///< The most probes that may be traced, in whole blocks.
};

/// Arguments of schedule_list, which lists the probes that are traced.
struct ScheduleListArguments {
  ScheduleStateArray state;
  ChunkArray chunks;
  UintArray bins;
  IntArray list;
  int count;
};

/// Arguments of update_variability. `changes` has an entry per probe of the list, as compare_light
/// computes it.
struct UpdateVariabilityArguments {
  ScheduleStateArray state;
  VariabilityArray variability;
  IntArray list;
  FloatArray blend_weights;
  Vec3Array changes;
  int count;
  uint chosen;  ///< 1: the device decided the length of the list.
  uint update;  ///< Number of the update, counted from 1.
  uint unused;
};

/// Arguments of schedule_means, which computes the mean deviation and mean light for the next
/// update.
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
