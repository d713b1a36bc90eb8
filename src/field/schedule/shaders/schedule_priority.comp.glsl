// SPDX-License-Identifier: Apache-2.0
// Sorts probes into priority bins. One lane per probe, one workgroup per chunk.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/schedule/schedule_arguments.h"
#include "field/probes/shaders/volume_of.glsl"

layout(local_size_x = kChunkProbes) in;
layout(push_constant, scalar) uniform Push {
  SchedulePriorityArguments args;
};

shared uint bins[kPriorityBins];
shared float deviations[kChunkProbes];  // of probes that have not converged, else 0

bool fetch_scheduled(int probe) { return args.probes.states.at[probe] != kProbeOff; }
float fetch_variance(int probe) { return args.variability.at[probe].known.variance; }
#include "field/schedule/neighbourhood_variance.inl.h"

/// The priority bin of a probe. `deviation` receives its deviation, or 0 where it has converged.
int bin_of(int probe, out float deviation) {
  deviation = 0.0;
  uint last_traced = args.variability.at[probe].last_traced;
  int volume = volume_of(args.grids, probe);
  float reduction = 0.0;
  if (fetch_scheduled(probe)) {
    float samples = args.probes.standing.at[probe].samples;
    float mean_around = neighbourhood_variance(args.grids.at[volume], probe);
    float held = probe_deviation(fetch_variance(probe), mean_around);
    reduction = error_reduction(held, samples, args.longest);
    if (reduction > 0.0) {
      deviation = held;
      reduction = scheduled_reduction(reduction, error_reduction_per_deviation(samples),
                                      args.state.at[0].mean_deviation);
    }
  } else if (args.look == 0u || !waits_too_long(last_traced, args.update)) {
    return kInactiveBin;
  }
  // Engines do not pass the camera, so that the weight depends on the cascade's level only
  float weight = level_weight(args.levels.at[volume]);
  return priority_bin(probe_urgency(reduction, last_traced, args.update, weight));
}

void main() {
  int lane = int(gl_LocalInvocationIndex);
  int probe = int(gl_GlobalInvocationID.x);
  if (lane < kPriorityBins) bins[lane] = 0u;
  deviations[lane] = 0.0;
  barrier();
  if (probe < args.count) {
    int bin = bin_of(probe, deviations[lane]);
    args.bins.at[probe] = uint(bin);
    atomicAdd(bins[bin], 1u);
  }
  barrier();
  if (lane < kPriorityBins) args.chunks.at[gl_WorkGroupID.x].bins[lane] = bins[lane];
  if (lane != 0) return;
  float sum = 0.0;
  uint unsettled = 0u;
  for (int i = 0; i < kChunkProbes; ++i) {
    sum += deviations[i];
    unsettled += deviations[i] > 0.0 ? 1u : 0u;
  }
  args.chunks.at[gl_WorkGroupID.x].deviation_sum = sum;
  args.chunks.at[gl_WorkGroupID.x].unsettled = unsettled;
}
