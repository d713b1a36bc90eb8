// SPDX-License-Identifier: Apache-2.0
// Multiplies the numbers of samples of all probes by a factor, so that their history has less
// weight, and restarts their placement if `place_again` is set. One lane per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/recorded_arguments.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  FadeSamplesArguments args;
};

void main() {
  int probe = int(gl_GlobalInvocationID.x);
  if (probe >= args.count) return;
  args.standing.at[probe].samples *= args.factor;
  if (args.place_again != 0u) args.standing.at[probe].placed = 0u;
}
