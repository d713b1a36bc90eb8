// SPDX-License-Identifier: Apache-2.0
// Adds what pixels show to their layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"
#include "compose/pixel_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ComposeArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint pixel = args.first_pixel + i;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  PixelLayers layers = args.layers.at[pixel];
  layers.emission += args.share * surface.emission;
  if ((surface.flags & kSurfaceMissed) != 0u) {
    layers.all += args.share * surface.emission;
    args.layers.at[pixel] = layers;
    return;
  }

  // Reflect the field's light: the base under the coat, and the coat by its directional albedo
  LitPointRecord point = args.points.at[i];
  vec3 diffuse = args.diffuse.at[i];
  vec3 glossy = args.specular.at[i];
  vec3 indirect = vec3(0.0f);
  if (args.has_indirect != 0u && surface.gi_share > 0.0) {
    vec3 irradiance = indirect_share(surface.gi_share, args.looked_up) * args.irradiance.at[i];
    indirect = reflected_indirect(surface.reflectance, irradiance);
    glossy += reflected_glossy(surface.reflectance, dot(point.normal_ws, surface.to_viewer_ws),
                               args.mirror_irradiance.at[i]);
    layers.irradiance += args.share * irradiance;
  }
  layers.direct += args.share * diffuse;
  layers.indirect += args.share * indirect;
  layers.glossy += args.share * glossy;
  layers.all += args.share * (diffuse + indirect + glossy + surface.emission);
  layers.albedo += args.share * surface.reflectance.diffuse;
  layers.normal += args.share * point.normal_ws;
  layers.position += args.share * point.position_ws;
  layers.depth -= args.share * dot(point.position_ws - args.camera_ws, args.camera_back);
  args.layers.at[pixel] = layers;
}
