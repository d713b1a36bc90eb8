// SPDX-License-Identifier: Apache-2.0
// Makes surfels from an engine's ray results, one lane per ray. Rays that were not traced do not
// count, like rays that hit back faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field/vulkan/recorded_arguments.h"
#include "shared/constants.h"
#include "shared/octahedral.h"

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

  SurfelRecord surfel;
  surfel.kind = left ? kSurfelSky : surface ? kSurfelSurface : kSurfelSolidSide;
  surfel.position_ws = from.origin_ws + (left ? 0.0 : result.distance) * from.direction_ws;
  surfel.normal_ws = encode_unit_vector(left ? -from.direction_ws : result.normal_ws);
  surfel.geometric_normal_ws =
      encode_unit_vector(left ? -from.direction_ws : result.geometric_normal_ws);
  surfel.material = 0u;
  surfel.receives_gi = surface ? 1u : 0u;
  surfel.albedo_over_pi = vec3(0.0);
  surfel.light = left ? result.radiance : vec3(0.0);
  if (surface) {
    vec3 albedo = clamp(result.albedo, 0.0, args.max_albedo);
    vec3 glows = vec3(greaterThan(result.radiance, vec3(0.0)));
    albedo = max(albedo, kLeastGlowingAlbedo * glows);
    surfel.albedo_over_pi = albedo * kInvPi;
    surfel.light = result.direct_irradiance;
    for (int c = 0; c < 3; ++c) {
      if (glows[c] > 0.0) surfel.light[c] += result.radiance[c] / surfel.albedo_over_pi[c];
    }
  }
  args.surfels.at[args.list.at[k] * args.stride + ray] = surfel;
}
