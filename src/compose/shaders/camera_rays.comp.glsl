// SPDX-License-Identifier: Apache-2.0
// Makes a ray through each pixel of a band.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"
#include "compose/pixel_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CameraRaysArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first_pixel + i;
  if (args.round_first > 0u && args.skipped.at[pixel] != 0u) {
    args.rays.at[i] = no_ray();
    return;
  }
  vec2 corner = vec2(float(pixel % args.width), float(pixel / args.width));
  vec2 offset = subpixel_position(args.index, args.samples, args.seed, args.jitter);
  CameraRay ray = camera_ray(args.camera, corner + offset);
  uint samples = args.samples - args.round_first;
  uint number = sample_number(args.index - args.round_first, samples, args.jitter);
  args.rays.at[i] =
      RayRecord(ray.origin_ws, 0.0f, ray.direction_ws, uintBitsToFloat(kMissedDistanceBits),
                sample_mask(pixel, number, samples, round_seed(args.seed, args.round_first)));
  args.cones.at[i] = camera_cone(args.camera, ray.direction_ws, args.samples, args.jitter);
}
