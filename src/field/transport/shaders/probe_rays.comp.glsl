// SPDX-License-Identifier: Apache-2.0
// Makes the rays of probes, one lane per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "field/transport/probe_rays.h"
#include "field/probes/shaders/volume_of.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  ProbeRaysArguments args;
};

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || ray >= args.rays_per_probe) return;
  int probe = args.probes.at[k];
  ProbeGrid grid = args.store.grids.at[volume_of(args.store.grids, probe)];
  vec3 offset = decode_probe_offset(args.store.offsets.at[probe]);
  vec3 origin = placed_position(grid, probe_coords(grid, probe), offset);
  args.rays.at[k * args.rays_per_probe + ray] =
      probe_ray_record(origin, args.directions.at[ray]);
}
