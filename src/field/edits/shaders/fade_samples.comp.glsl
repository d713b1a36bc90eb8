// SPDX-License-Identifier: Apache-2.0
// Has what probes averaged count for less: a lane a probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/recorded_arguments.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  FadeSamplesArguments args;
};

void main() {
  int probe = int(gl_GlobalInvocationID.x);
  if (probe < args.count) args.standing.at[probe].samples *= args.factor;
}
