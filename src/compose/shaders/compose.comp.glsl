// SPDX-License-Identifier: Apache-2.0
// Adds a sample of the pixels to their layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/frame_records.h"
#include "compose/pixel_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  ComposeArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint pixel = args.first_pixel + k;
  uint i = args.first + k;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  PixelLayers layers = args.layers.at[pixel];
  bool has_fog = (args.has & kHasFog) != 0u;
  vec4 fog = has_fog ? args.fog.at[i] : vec4(0.0f, 0.0f, 0.0f, 1.0f);
  float share = args.share * surface.sample_weight;
  float seen = share * fog.w;
  layers.fog += share * vec3(fog);
  layers.emission += seen * surface.emission;
  if ((surface.flags & kSurfaceMissed) != 0u) {
    layers.all += seen * surface.emission + share * vec3(fog);
    args.layers.at[pixel] = layers;
    return;
  }

  // Reflect the field's light: by the base under the coat, and by the coat's directional albedo
  LitPointRecord point = args.points.at[i];
  vec3 diffuse = args.diffuse.at[i];
  vec3 glossy = args.specular.at[i];
  float n_dot_v = dot(point.normal_ws, surface.to_viewer_ws);
  vec3 indirect = vec3(0.0f);
  if ((args.has & kHasIndirect) != 0u && surface.gi_share > 0.0) {
    if ((args.has & kIsFiltered) == 0u) {
      vec3 irradiance =
          indirect_share(surface.gi_share, args.has & kIsLookedUp) * args.irradiance.at[i];
      indirect = reflected_indirect(surface.reflectance, n_dot_v, irradiance);
      layers.irradiance += share * irradiance;
    }
    vec4 coats = (args.has & kHasCoats) != 0u ? args.coats.at[i] : vec4(0.0f);
    if ((args.has & kCoatsAreFiltered) != 0u) coats = vec4(vec3(0.0f), coats.w);
    glossy += coat_light(surface.reflectance, n_dot_v, surface.gi_share, coats,
                         args.mirror_irradiance.at[i]);
    if ((args.has & kHasClearcoats) == 0u) {
      glossy += clearcoat_light(surface.reflectance.layers, surface.gi_share,
                                args.mirror_irradiance.at[i]);
    }
  }
  vec3 transmitted = vec3(0.0f);
  if ((args.has & kHasTransmission) != 0u) {
    transmitted = args.transmitted.at[i].radiance + args.transmitted.at[i].mirrored;
  }
  layers.direct += seen * diffuse;
  layers.indirect += seen * indirect;
  layers.glossy += seen * glossy;
  layers.transmission += seen * transmitted;
  layers.all +=
      seen * (diffuse + indirect + glossy + transmitted + surface.emission) + share * vec3(fog);
  layers.albedo += share * surface.reflectance.diffuse;
  layers.normal += share * point.normal_ws;
  layers.position += share * point.position_ws;
  layers.depth -= share * dot(point.position_ws - args.camera_ws, args.camera_back);
  args.layers.at[pixel] = layers;
}
