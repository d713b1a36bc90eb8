// SPDX-License-Identifier: Apache-2.0
// Irradiance of pixels from what their rays gathered: rays are drawn in proportion to the cosine,
// so it is pi times their mean radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  GatherSumArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint i = args.first + k;
  vec3 geometric_normal_ws = args.points.at[i].geometric_normal_ws;
  float weight = kPi / float(args.rays_per_pixel);
  vec3 sum = vec3(0.0f);
  for (uint r = 0u; r < args.rays_per_pixel; ++r) {
    uint at = k * args.rays_per_pixel + r;
    RayRecord ray = args.rays.at[at];
    // A bent normal's hemisphere reaches below the surface, where no light comes from
    if (ray.mask == 0u || dot(geometric_normal_ws, ray.direction_ws) <= 0.0f) continue;
    ShadedHitRecord hit = args.shaded.at[at];
    vec3 lit = args.direct.at[at];
    if ((hit.flags & kSurfaceReceivesGi) != 0u) lit += args.field.at[at];
    vec3 sky = (hit.flags & kSurfaceMissed) != 0u ? hit.radiance : vec3(0.0f);
    sum += weight * (hit.albedo_over_pi * lit + sky);
  }
  args.irradiance.at[i] = sum;
}
