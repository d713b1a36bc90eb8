// SPDX-License-Identifier: Apache-2.0
// Lists the probes that an update traces, in the order of their indices. One lane per probe, one
// workgroup per chunk.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/schedule/schedule_arguments.h"

layout(local_size_x = kChunkProbes) in;
layout(push_constant, scalar) uniform Push {
  ScheduleListArguments args;
};

// For each probe of a chunk: of the probes up to it, the number in higher bins than the last bin
// that is traced, and the number in that bin.
shared ivec2 counts[kChunkProbes];
// The sums of both numbers over all chunks before this one.
shared int higher_before;
shared int last_before;

void main() {
  int lane = int(gl_LocalInvocationIndex);
  int probe = int(gl_GlobalInvocationID.x);
  int last = args.state.at[0].last_bin;
  int bin = probe < args.count ? int(args.bins.at[probe]) : -1;
  ivec2 own = ivec2(bin > last ? 1 : 0, bin == last ? 1 : 0);

  // Compute prefix sums: Hillis and Steele, "Data Parallel Algorithms", CACM 29(12), 1986
  counts[lane] = own;
  if (lane == 0) higher_before = last_before = 0;
  barrier();
  for (int c = lane; c < int(gl_WorkGroupID.x); c += kChunkProbes) {
    atomicAdd(higher_before, args.chunks.at[c].higher);
    atomicAdd(last_before, args.chunks.at[c].of_last);
  }
  for (int step = 1; step < kChunkProbes; step *= 2) {
    ivec2 before = lane >= step ? counts[lane - step] : ivec2(0);
    barrier();
    counts[lane] += before;
    barrier();
  }

  ivec2 before = counts[lane] - own + ivec2(higher_before, last_before);
  int of_last = args.state.at[0].of_last_bin;
  bool chosen = own.x != 0 || (own.y != 0 && before.y < of_last);
  if (chosen) args.list.at[before.x + min(before.y, of_last)] = probe;
}
