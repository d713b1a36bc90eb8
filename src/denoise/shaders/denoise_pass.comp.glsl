// SPDX-License-Identifier: Apache-2.0
// Runs a pass of the filter over a picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "denoise/denoise_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  DenoisePassArguments args;
};

#define Real float
#define Real3 vec3
#define LAMBENT_REAL_FN
#define LAMBENT_UNROLL_TAPS

ivec2 pixel;

float zero_unless_positive(float condition, float value) {
  return condition > 0.0f ? value : 0.0f;
}

float larger(float a, float b) {
  return max(a, b);
}

float smaller(float a, float b) {
  return min(a, b);
}

/// The pixel that is offset by (x, y) from this one.
uint pixel_at(int x, int y) {
  uint column = uint(mirrored_place(pixel.x + x, int(args.width)));
  return uint(mirrored_place(pixel.y + y, int(args.height))) * args.width + column;
}

float fetch_guide(int plane, int x, int y) {
  uint i = pixel_at(x, y);
  if (plane == kLevelPlane) return args.levels.at[i];
  float depth = args.depths.at[i];
  if (plane == kInverseDepthPlane) return depth > 0.0f ? 1.0f / depth : 0.0f;
  if (plane < kNormalPlane) return args.positions_ws.at[i][plane - kPositionPlane];
  if (args.by.has_lobes != 0u && args.lobes.at[i].sharpness <= 0.0f) return 0.0f;
  return depth > 0.0f ? args.normals_ws.at[i][plane - kNormalPlane] : 0.0f;
}

float fetch_light(int plane, int x, int y) {
  uint i = pixel_at(x, y);
  if (plane == kSpreadPlane) return args.in_light.at[i].spread;
  if (plane == kSharePlane) {
    return args.in_light.at[i].share *
           mirrored_share(beyond_ends(pixel.x + x, int(args.width)), args.by.apart) *
           mirrored_share(beyond_ends(pixel.y + y, int(args.height)), args.by.apart);
  }
  return plane < kSpreadPlane ? args.in_light.at[i].light[plane - kLightPlane]
                              : args.in_light.at[i].base[plane - kBasePlane];
}

float fetch_lobe(int plane, int x, int y) {
  uint i = pixel_at(x, y);
  if (plane == kLobeSharpnessPlane) return args.lobes.at[i].sharpness;
  if (plane == kInverseHitDistancePlane) return args.lobes.at[i].inverse_distance;
  return plane < kAcrossPlane ? args.lobes.at[i].mirror_ws[plane - kMirrorPlane]
                              : args.lobes.at[i].across_ws[plane - kAcrossPlane];
}

#include "denoise/atrous.inl.h"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.width * args.height) return;
  pixel = ivec2(int(i % args.width), int(i / args.width));
  AtrousLight filtered = filtered_pixel(args.by);
  args.out_light.at[i] =
      DenoiseRecord(filtered.light, filtered.spread, filtered.base, filtered.share);
}
