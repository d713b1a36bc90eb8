// SPDX-License-Identifier: Apache-2.0
// Makes surfels from shaded hits, one lane per surfel. The twin of make_surfel() in surfels.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/device_arguments.h"
#include "shared/octahedral.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  MakeSurfelsArguments args;
};

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || ray >= args.rays_per_probe) return;
  int i = k * args.rays_per_probe + ray;
  LitPointRecord point = args.points.at[i];
  ShadedHitRecord shaded = args.shaded.at[i];
  SurfelRecord surfel;
  surfel.position_ws = point.position_ws;
  surfel.normal_ws = encode_unit_vector(point.normal_ws);
  surfel.geometric_normal_ws = encode_unit_vector(point.geometric_normal_ws);
  bool sky = (shaded.flags & kSurfaceMissed) != 0u;
  bool counts = (shaded.flags & kSurfaceDiscounted) == 0u;
  surfel.kind = sky ? kSurfelSky : counts ? kSurfelSurface : kSurfelSolidSide;
  surfel.material = sky ? 0u : shaded.material;
  surfel.albedo_over_pi = sky ? vec3(0.0) : shaded.albedo_over_pi;
  surfel.light = sky ? shaded.radiance : args.irradiance.at[i];
  surfel.receives_gi = !sky && (shaded.flags & kSurfaceReceivesGi) != 0u ? 1u : 0u;
  args.surfels.at[args.probes.at[k] * args.stride + ray] = surfel;
}
