// SPDX-License-Identifier: Apache-2.0
// Updates the variance of the probes that were traced, and stores the number of the update. One
// lane per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/schedule/schedule_arguments.h"
#include "field/probes/shaders/tiles.glsl"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  UpdateVariabilityArguments args;
};

void main() {
  int k = int(gl_GlobalInvocationID.x);
  int count = args.chosen != 0u ? int(args.state.at[0].list.probes) : args.count;
  if (k >= count) return;
  float blend_weight = args.blend_weights.at[k];
  if (blend_weight == 0.0) return;
  int probe = args.list.at[k];
  ProbeVariability variability = args.variability.at[probe];
  vec3 change = args.changes.at[k];
  float estimate_square = estimate_relative_square(
      LightChange(change.x, change.y, change.z), kIrradianceTexels * kIrradianceTexels,
      blend_weight, args.state.at[0].mean_light);
  variability.known =
      learned_variance(variability.known, estimate_square, 1.0, 1.0 / blend_weight - 1.0);
  variability.last_traced = args.update;
  args.variability.at[probe] = variability;
}
