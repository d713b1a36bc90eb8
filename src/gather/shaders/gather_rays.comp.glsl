// SPDX-License-Identifier: Apache-2.0
// Makes the rays that gather the light of pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather/gather_math.h"
#include "gather/gather_records.h"
#include "shared/rays.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  GatherRaysArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint i = args.first + k;
  LitPointRecord point = args.points.at[i];
  bool asks = (args.surfaces.at[i].flags & kSurfaceMissed) == 0u;
  uint pixel = args.first_pixel + i;
  args.first_indices.at[k] = pixel * args.rays_per_pixel;

  Frame frame = make_frame(point.normal_ws);
  vec3 origin_ws = offset_ray_origin(point.position_ws, point.geometric_normal_ws);
  for (uint r = 0u; r < args.rays_per_pixel; ++r) {
    vec2 drawn = pixel_point(pixel % args.width, pixel / args.width, r, args.rays_per_pixel,
                              args.index, args.seed);
    args.rays.at[k * args.rays_per_pixel + r] =
        RayRecord(origin_ws, 0.0f, gather_direction(frame, drawn),
                  uintBitsToFloat(kMissedDistanceBits), asks ? kRayGathers : 0u);
  }
}
