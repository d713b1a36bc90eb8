// SPDX-License-Identifier: Apache-2.0
// The rays of probes: a lane each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/device_arguments.h"
#include "field/probe_rays.h"
#include "field/shaders/volume_of.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  ProbeRaysArguments args;
};

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.probes || ray >= args.stride) return;
  RaySetRecord set = args.list.sets.at[args.list.ray_sets.at[k]];
  int probe = args.list.probes.at[k];
  ProbeGrid grid = args.store.grids.at[volume_of(args.store.grids, probe)];
  vec3 offset = decode_probe_offset(args.store.offsets.at[probe]);
  vec3 origin = placed_position(grid, probe_coords(grid, probe), offset);
  RayRecord record = probe_ray_record(origin, set.directions.at[min(ray, set.rays - 1)]);
  if (ray >= set.rays) record.mask = 0u;
  args.rays.at[k * args.stride + ray] = record;
}
