// SPDX-License-Identifier: Apache-2.0
// Makes the rays of probes that an engine traces, one lane per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/probes/shaders/volume_of.glsl"
#include "field/transport/probe_rays.h"
#include "field/vulkan/recorded_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  RecordedRaysArguments args;
};

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || ray >= args.rays_per_probe) return;
  if (args.is_chosen != 0u && k >= int(args.chosen.at[0])) {
    args.rays.at[k * args.rays_per_probe + ray].mask = 0u;
    return;
  }
  int probe = args.list.probes.at[k];
  ProbeGrid grid = args.grids.at[volume_of(args.grids, probe)];
  vec3 offset = decode_probe_offset(args.probes.standing.at[probe].offset);
  vec3 origin = placed_position(grid, probe_coords(grid, probe), offset);
  Vec3Array directions = args.list.sets.at[args.list.ray_sets.at[k]].directions;
  RayRecord record = probe_ray_record(origin, directions.at[ray]);
  bool rests = probe_is_skipped(args.probes.states.at[probe], args.probes.standing.at[probe].placed,
                           args.placing_updates, args.all);
  record.mask = rests ? 0u : args.mask;
  args.rays.at[k * args.rays_per_probe + ray] = record;
}
