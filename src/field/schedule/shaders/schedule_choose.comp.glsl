// SPDX-License-Identifier: Apache-2.0
// Decides how many probes an update traces, down to which bin, and the numbers of workgroups of the
// kernels that work on them. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/schedule/schedule_arguments.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = kChunkProbes) in;
layout(push_constant, scalar) uniform Push {
  ScheduleChooseArguments args;
};

shared uint bins[kPriorityBins];
shared uint chosen;
shared int last_bin;

/// Takes probes from the highest bin downwards, until the budget is spent or no probe needs rays,
/// rounded up to a whole block.
void choose() {
  uint wanting = 0u;
  uint live = 0u;
  for (int bin = kConvergedBin; bin < kPriorityBins; ++bin) {
    live += bins[bin];
    if (bin >= kFirstReductionBin) wanting += bins[bin];
  }
  uint block = uint(kBlockProbes);
  chosen = min((wanting + block - 1u) / block * block, uint(args.most));
  uint left = chosen;
  int last = kPriorityBins - 1;
  while (last > 0 && bins[last] < left) left -= bins[last--];
  last_bin = last;
  args.state.at[0].last_bin = last;
  args.state.at[0].of_last_bin = int(left);
  args.state.at[0].live = live;
  args.state.at[0].list.probes = chosen;
  args.state.at[0].list.texels = chosen * uint(kIrradianceTexels * kIrradianceTexels);
  args.state.at[0].list.largest_blend_weight = 0u;
}

void main() {
  int lane = int(gl_LocalInvocationIndex);
  if (lane < kPriorityBins) {
    bins[lane] = 0u;
    for (int c = 0; c < args.chunk_count; ++c) bins[lane] += args.chunks.at[c].bins[lane];
  }
  barrier();
  if (lane == 0) choose();
  barrier();
  for (int c = lane; c < args.chunk_count; c += kChunkProbes) {
    uint higher = 0u;
    for (int bin = last_bin + 1; bin < kPriorityBins; ++bin) higher += args.chunks.at[c].bins[bin];
    args.chunks.at[c].higher = int(higher);
    args.chunks.at[c].of_last = int(args.chunks.at[c].bins[last_bin]);
  }
  uint blocks = chosen / uint(kBlockProbes);
  if (lane < kListShapes) {
    args.state.at[0].list.over[lane] = list_groups(args.sizes.at[lane], chosen, blocks);
  }
  for (int b = lane; b < args.most / kBlockProbes; b += kChunkProbes) {
    int count = uint(b) < blocks ? kBlockProbes : 0;
    args.blocks.at[b] = ProbeBlock(b * kBlockProbes, count, 0);
  }
}
