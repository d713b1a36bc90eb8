// SPDX-License-Identifier: Apache-2.0
// Keeps of a band's pixels what the filter reads; see filter_frame.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"
#include "shared/variance.h"
#include "raytracing/shaders/unoccluded_light.glsl"
#include "shared/demodulate.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepPixelsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first + i;
  LitPointRecord point = args.points.at[i];
  PixelSurfaceRecord surface = args.surfaces.at[i];
  bool seen = (surface.flags & kSurfaceMissed) == 0u;
  float depth = -dot(point.position_ws - args.camera_ws, args.camera_back);
  args.pixels.at[0].positions_ws.at[pixel] = point.position_ws;
  args.pixels.at[0].normals_ws.at[pixel] = point.normal_ws;
  args.pixels.at[0].geometric_normals_ws.at[pixel] = point.geometric_normal_ws;
  args.pixels.at[0].depths.at[pixel] = seen ? depth : 0.0f;
  float passed = args.has_fog != 0u ? args.fog.at[i].w : 1.0f;
  if (args.draws > 0u) {
    vec3 albedo = filtered_albedo(surface.reflectance);
    vec3 light = seen ? args.emitters.at[i] / albedo : vec3(0.0f);
    float level = 0.0f;
    if (seen) {
      level = filtered_level(unoccluded_light(args.scene, point.position_ws, point.normal_ws),
                             luminance(light));
    }
    float inverse = inverse_level(level);
    args.pixels.at[0].emitter_levels.at[pixel] = level;
    args.pixels.at[0].emitter_albedo.at[pixel] = passed * level * albedo;
    args.pixels.at[0].emitters.at[pixel] = inverse * light;
    if (args.draws > 1u) {
      args.pixels.at[0].emitter_variance.at[pixel] =
          seen ? inverse * inverse *
                     variance_of_sum(luminance(light), args.emitter_squares.at[i], args.draws)
               : 0.0f;
    }
  }
  if (args.gathered != 0u) {
    float share = seen ? surface.gi_share : 0.0f;
    args.pixels.at[0].looked_up.at[pixel] = seen ? share * args.irradiance.at[i] : vec3(0.0f);
    args.pixels.at[0].receives.at[pixel] = share > 0.0f ? 1u : 0u;
    float n_dot_v = dot(point.normal_ws, surface.to_viewer_ws);
    args.pixels.at[0].indirect_albedo.at[pixel] =
        seen ? passed * reflected_indirect(surface.reflectance, n_dot_v, vec3(1.0f)) : vec3(0.0f);
  }
}
