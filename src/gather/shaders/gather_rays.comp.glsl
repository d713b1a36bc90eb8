// SPDX-License-Identifier: Apache-2.0
// Makes the rays that gather the light of pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather/gather_math.h"
#include "gather/gather_records.h"
#include "gather/guide_math.h"
#include "shared/rays.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  GatherRaysArguments args;
};

GuidePoint fetch_guide_point(int point) { return args.guide.at[point]; }
vec3 fetch_bright_place(int place) { return args.places.at[place]; }
#include "gather/guide.inl.h"

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
  uint width = uint(args.size.picture_width);
  PixelRays rays = PixelRays(pixel % width, pixel / width, args.rays_per_pixel, args.index,
                             args.seed);
  int by = guiding_point(args.size, rays, point.normal_ws);
  uint guided = by < 0 ? 0u : guided_rays(fetch_guide_point(by).share, args.rays_per_pixel);
  args.guided.at[k] = guided;
  for (uint r = 0u; r < args.rays_per_pixel; ++r) {
    GatherRay drawn = gather_ray(rays, r, by, guided, point.position_ws, frame);
    uint at = k * args.rays_per_pixel + r;
    args.rays.at[at] = RayRecord(origin_ws, 0.0f, drawn.direction_ws,
                                 uintBitsToFloat(kMissedDistanceBits), asks ? kRayGathers : 0u);
    args.weights.at[at] = drawn.weight;
  }
}
