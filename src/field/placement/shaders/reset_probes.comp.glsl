// SPDX-License-Identifier: Apache-2.0
// Resets all data of probes that have new places in a recorded field. One row of lanes per probe,
// one lane per word of its distance tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/placement/reset_arguments.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  ResetProbesArguments args;
};

void main() {
  int lane = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count) return;
  int probe = args.list.at[k];
  // Distances of 0 give a probe no weight in lookups
  if (lane < args.distance_words) args.distance.at[probe * args.distance_words + lane] = 0u;
  const int texels = kIrradianceTexels * kIrradianceTexels;
  if (lane < texels) {
    args.light.at[probe * texels + lane] = vec4(0.0);
    args.last_irradiance_estimate.at[probe * texels + lane] = vec4(0.0);
  }
  if (lane != 0) return;
  args.offsets.at[probe] = 0u;
  args.probes.states.at[probe] = kProbeOn;
  args.probes.standing.at[probe].samples = 0.0;
  args.probes.standing.at[probe].offset = 0u;
  args.probes.standing.at[probe].placed = 0u;
  if (args.has_variability != 0u) args.variability.at[probe] = new_variability();
}
