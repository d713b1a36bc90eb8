// SPDX-License-Identifier: Apache-2.0
// Computes the blend weights of a recorded field's probes and counts their samples, one lane per
// probe. Sets each probe's offset in the store to the position from which its rays started.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/transport/blend_math.h"
#include "field/vulkan/recorded_arguments.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  RecordedBlendWeightsArguments args;
};

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= (args.is_chosen != 0u ? int(args.chosen.at[0]) : args.count)) return;
  int probe = args.list.at[k];
  if (probe_is_skipped(args.probes.states.at[probe], args.probes.standing.at[probe].placed,
                  args.placing_updates, args.all)) {
    args.blend_weights.at[k] = 0.0;
    return;
  }
  args.offsets.at[probe] = args.probes.standing.at[probe].offset;
  float averaged = args.probes.standing.at[probe].samples;
  if (args.history == kHistoryRetraced) {
    // The history ratio preserves the average
    bool known = has_history(args.probes.states.at[probe], averaged);
    args.probes.standing.at[probe].samples = known ? averaged : 1.0;
    args.blend_weights.at[k] = 1.0;
    return;
  }
  if (args.history == kHistoryDiscarded) averaged = 0.0;
  float blend_weight = history_blend_weight(averaged, 1.0, args.longest);
  args.blend_weights.at[k] = blend_weight;
  // Positive floats are ordered as their bits are
  if (args.is_chosen != 0u) {
    atomicMax(args.largest_blend_weight.at[0], floatBitsToUint(blend_weight));
  }
  args.probes.standing.at[probe].samples = min(averaged + 1.0, args.longest);
  args.probes.standing.at[probe].coarse = 1u;
}
