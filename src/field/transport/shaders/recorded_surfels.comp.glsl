// SPDX-License-Identifier: Apache-2.0
// Makes surfels from an engine's ray results, one lane per ray. Rays that were not traced do not
// count, like rays that hit back faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/recorded_arguments.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push {
  RecordedSurfelsArguments args;
};

// A surfel stores the light that arrives, of which it reflects its albedo. Emitted light is stored
// as additional arriving light, divided by the albedo. For this, an emitting surfel has at least
// this albedo, which is too small for other reflected light to be visible.
const float kLeastGlowingAlbedo = 1e-3;

void main() {
  int ray = int(gl_GlobalInvocationID.x);
  int k = int(gl_GlobalInvocationID.y);
  if (k >= args.count || ray >= args.rays_per_probe) return;
  int i = k * args.rays_per_probe + ray;
  RayRecord from = args.rays.at[i];
  RayResult result = args.results.at[i];
  if (from.mask == 0u) result = ray_met_back_face(0.0, -from.direction_ws);
  bool left = result.kind == kRayLeft;
  bool surface = result.kind == kRayMetSurface;

  ShadedHitRecord hit = shaded_sky(result.radiance);
  vec3 position_ws = from.origin_ws;
  vec3 normal_ws = -from.direction_ws;
  vec3 geometric_normal_ws = -from.direction_ws;
  vec3 irradiance = vec3(0.0);
  if (!left) {
    hit.flags = surface ? kSurfaceReceivesGi : kSurfaceDiscounted;
    position_ws += result.distance * from.direction_ws;
    normal_ws = result.normal_ws;
    geometric_normal_ws = result.geometric_normal_ws;
  }
  if (surface) {
    vec3 albedo = clamp(result.albedo, 0.0, args.max_albedo);
    vec3 glows = vec3(greaterThan(result.radiance, vec3(0.0)));
    hit.albedo_over_pi = max(albedo, kLeastGlowingAlbedo * glows) * kInvPi;
    irradiance = result.direct_irradiance;
    for (int c = 0; c < 3; ++c) {
      if (glows[c] > 0.0) irradiance[c] += result.radiance[c] / hit.albedo_over_pi[c];
    }
  }
  args.surfels.at[args.list.at[k] * args.stride + ray] =
      surfel_record(position_ws, normal_ws, geometric_normal_ws, hit, irradiance);
}
