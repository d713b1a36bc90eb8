// SPDX-License-Identifier: Apache-2.0
// Stores the light of a band's clearcoats for the filter; see filter_frame.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"
#include "compose/pixel_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  KeepClearcoatsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first + i;
  PixelSurfaceRecord coat = args.surfaces.at[i];
  if ((coat.flags & kSurfaceSkipped) != 0u) return;
  args.pixels.at[0].clearcoats.at[pixel] = vec3(0.0f);
  args.pixels.at[0].clearcoat_excess.at[pixel] = vec3(0.0f);
  args.pixels.at[0].clearcoat_lobes.at[pixel].sharpness = 0.0f;
  if ((coat.flags & kSurfaceMissed) != 0u || args.has_rays == 0u) return;
  vec4 by_rays = args.coats.at[i];
  if (by_rays.w <= 0.0f || !is_filtered_clearcoat(coat.reflectance.alpha)) return;
  vec3 normal_ws = args.points.at[i].normal_ws;
  vec3 albedo =
      filtered_coat_albedo(coat.reflectance, dot(normal_ws, coat.to_viewer_ws), by_rays.w);
  CoatGuide guide = args.guides.at[i];
  vec3 light = without_excess(vec3(by_rays), guide.excess) / albedo;
  args.pixels.at[0].clearcoats.at[pixel] = light;
  args.pixels.at[0].clearcoat_variance.at[pixel] = variance_of_ray(guide, light);
  args.pixels.at[0].clearcoat_excess.at[pixel] = guide.excess / albedo;
  args.pixels.at[0].clearcoat_albedo.at[pixel] = albedo;
  args.pixels.at[0].clearcoat_normals_ws.at[pixel] = normal_ws;
  args.pixels.at[0].clearcoat_lobes.at[pixel] =
      lobe_guide(normal_ws, coat.to_viewer_ws, coat.reflectance.alpha, guide.inverse_distance);
  args.coats.at[i] = vec4(vec3(0.0f), by_rays.w);
}
