// SPDX-License-Identifier: Apache-2.0
// Computes the blend weights of a recorded field's probes and counts their samples, one lane per
// probe. From now on, lookups find each probe where its rays started.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/schedule/schedule_math.h"
#include "field/vulkan/recorded_arguments.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  RecordedBlendWeightsArguments args;
};

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= (args.is_chosen != 0u ? int(args.chosen.at[0]) : args.count)) return;
  int probe = args.list.at[k];
  if (probe_rests(args.probes.states.at[probe], args.probes.standing.at[probe].placed,
                  args.placing_updates, args.all)) {
    args.blend_weights.at[k] = 0.0;
    return;
  }
  float averaged = args.discards_history != 0u ? 0.0 : args.probes.standing.at[probe].samples;
  float blend_weight = history_blend_weight(averaged, 1.0, args.longest);
  args.blend_weights.at[k] = blend_weight;
  // Positive floats are ordered as their bits are
  if (args.is_chosen != 0u) {
    atomicMax(args.largest_blend_weight.at[0], floatBitsToUint(blend_weight));
  }
  args.probes.standing.at[probe].samples = min(averaged + 1.0, args.longest);
  args.offsets.at[probe] = args.probes.standing.at[probe].offset;
}
