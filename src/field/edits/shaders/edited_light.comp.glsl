// SPDX-License-Identifier: Apache-2.0
// Stores the direct light along the rays of probes before an edit, and sums it up together with
// that after it. One lane per probe: sums in the order of the rays are the same on all devices.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/edits/edit_arguments.h"

layout(local_size_x = kGroupLanes) in;
layout(push_constant, scalar) uniform Push {
  EditedLightArguments args;
};

/// Light along a ray of a probe, from its surfel.
float light_along(int probe, int ray) {
  SurfelRecord surfel = args.surfels.at[probe * args.stride + ray];
  return ray_light(surfel.kind, surfel.albedo_over_pi, surfel.light);
}

void main() {
  int k = int(gl_GlobalInvocationID.x);
  if (k >= args.count) return;
  int probe = args.list.probes.at[k];
  int rays = args.list.sets.at[args.list.ray_sets.at[k]].rays;
  int own = k * args.ray_stride;
  if (args.step == kKeepLight) {
    for (int ray = 0; ray < rays; ++ray) args.light_before.at[own + ray] = light_along(probe, ray);
    return;
  }
  EditedLight sums = EditedLight(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int ray = 0; ray < rays; ++ray) {
    sums = add_ray(sums, args.light_before.at[own + ray], light_along(probe, ray));
  }
  args.edited.at[k] = sums;
}
