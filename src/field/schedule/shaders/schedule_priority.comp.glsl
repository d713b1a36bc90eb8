// SPDX-License-Identifier: Apache-2.0
// Sorts probes into priority bins. One lane per probe, one workgroup per chunk.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/schedule/schedule_arguments.h"
#include "field/schedule/shaders/noise_around.glsl"

layout(local_size_x = kChunkProbes) in;
layout(push_constant, scalar) uniform Push {
  SchedulePriorityArguments args;
};

shared uint bins[kPriorityBins];
shared float noises[kChunkProbes];  // of probes that have not converged, else 0

/// The priority bin of a probe. `noise` receives its noise, or 0 where it has converged.
int bin_of(int probe, out float noise) {
  noise = 0.0;
  ProbeService service = args.service.at[probe];
  if (args.probes.states.at[probe] == kProbeOff) {
    bool look = args.look != 0u && waits_too_long(service.served, args.update);
    return look ? priority_bin(0.0, service.served, args.update) : kNoPartBin;
  }
  float samples = args.probes.standing.at[probe].samples;
  float around = noise_around(args.grids, args.probes.states, args.service, probe);
  float held = probe_noise(service.known.noise, around);
  float reduction = error_reduction(held, samples, args.longest);
  if (reduction > 0.0) {
    noise = held;
    float min_noise = kMinNoiseOfMean * args.state.at[0].mean_noise;
    reduction = max(reduction, min_noise * error_reduction_per_noise(samples));
  }
  return priority_bin(reduction, service.served, args.update);
}

void main() {
  int lane = int(gl_LocalInvocationIndex);
  int probe = int(gl_GlobalInvocationID.x);
  if (lane < kPriorityBins) bins[lane] = 0u;
  noises[lane] = 0.0;
  barrier();
  if (probe < args.count) {
    int bin = bin_of(probe, noises[lane]);
    args.bins.at[probe] = uint(bin);
    atomicAdd(bins[bin], 1u);
  }
  barrier();
  if (lane < kPriorityBins) args.chunks.at[gl_WorkGroupID.x].bins[lane] = bins[lane];
  if (lane != 0) return;
  float sum = 0.0;
  uint unsettled = 0u;
  for (int i = 0; i < kChunkProbes; ++i) {
    sum += noises[i];
    unsettled += noises[i] > 0.0 ? 1u : 0u;
  }
  args.chunks.at[gl_WorkGroupID.x].noise_sum = sum;
  args.chunks.at[gl_WorkGroupID.x].unsettled = unsettled;
}
