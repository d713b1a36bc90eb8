// SPDX-License-Identifier: Apache-2.0
// Makes the rays of secondary gathers, one for each ray that gathers light, or for each one that
// follows such a ray; those that have none are not traced.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/secondary/secondary_math.h"
#include "field/secondary/secondary_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  SecondaryRaysArguments args;
};

ProbeGrid fetch_grid(int volume) { return args.grids.at[volume]; }
#include "field/lookup/spacing.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint index = args.first_indices.at[i / args.rays_per_index] + i % args.rays_per_index;
  args.indices.at[i] = index;
  args.rays.at[i] = no_ray();
  if (args.rays_before.at[i].mask == 0u || !reads_field(args.shaded.at[i])) return;
  LitPointRecord point = args.points.at[i];
  SecondaryRay drawn = secondary_ray(
      point.position_ws, point.normal_ws, point.geometric_normal_ws,
      min(point.viewer_distance, point.light_distance),
      spacing_at(args.volumes, point.position_ws), index, args.salt, args.seed);
  if (!drawn.traced) return;
  // Lookups by rays skip a query with a normal of 0
  args.queries.at[i].normal_ws = vec3(0.0f);
  if (args.counts != 0u) atomicAdd(args.traced.at[0], 1u);
  args.rays.at[i] = RayRecord(drawn.origin_ws, 0.0f, drawn.direction_ws,
                              uintBitsToFloat(kMissedDistanceBits), kRayGathers);
}
