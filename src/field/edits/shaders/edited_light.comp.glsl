// SPDX-License-Identifier: Apache-2.0
// Stores the direct light along the rays of probes before an edit, and sums it up together with
// that after it, in the order of the rays. One lane per probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  EditedLightArguments args;
};

float light_along_ray(SurfelRecord surfel) {
  return ray_light(surfel.kind, surfel.albedo_over_pi, surfel.light);
}

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= args.count) return;
  int probe = args.list.probes.at[k];
  int rays = args.list.sets.at[args.list.ray_sets.at[k]].rays;
  int own = k * args.ray_stride;
  if (args.step == kKeepLight) {
    for (int ray = 0; ray < rays; ++ray) {
      args.light_before.at[own + ray] = light_along_ray(args.surfels.at[probe * args.stride + ray]);
    }
    return;
  }
  EditedLight sums = EditedLight(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int ray = 0; ray < rays; ++ray) {
    SurfelRecord surfel = args.surfels.at[probe * args.stride + ray];
    sums = add_ray(sums, surfel.kind, args.light_before.at[own + ray], light_along_ray(surfel));
  }
  args.edited.at[k] = sums;
}
