// SPDX-License-Identifier: Apache-2.0
// Updates the mean light of all probes from the probes just traced, and their mean deviation from
// the chunks. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/schedule/schedule_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  ScheduleMeansArguments args;
};

// Sum of luminance and number of probes; sum of deviations and number of probes
shared vec4 partial[kGroupLanes];

void main() {
  int lane = int(gl_LocalInvocationIndex);
  int count = args.chosen != 0u ? int(args.state.at[0].list.probes) : args.count;
  vec4 sum = vec4(0.0);
  for (int k = lane; k < count; k += kGroupLanes) {
    if (args.blend_weights.at[k] > 0.0) sum += vec4(args.changes.at[k].z, 1.0, 0.0, 0.0);
  }
  for (int c = lane; args.chosen != 0u && c < args.chunk_count; c += kGroupLanes) {
    sum += vec4(0.0, 0.0, args.chunks.at[c].deviation_sum, float(args.chunks.at[c].unsettled));
  }
  partial[lane] = sum;
  barrier();
  if (lane != 0) return;
  for (int other = 1; other < kGroupLanes; ++other) sum += partial[other];
  args.state.at[0].mean_deviation = sum.w > 0.0 ? sum.z / sum.w : 0.0;
  if (sum.y == 0.0) return;
  float live = float(args.state.at[0].live);
  args.state.at[0].mean_light =
      learned_light(args.state.at[0].mean_light, sum.x / sum.y, sum.y, live);
}
