// SPDX-License-Identifier: Apache-2.0
// Computes the texels of a camera's map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/vulkan/device_maps.h"
#include "rsm/maps/map_texel.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push {
  CameraTexelsArguments args;
};

RsmTexelRecord texel_at(ivec2 place, int i) {
  HitRecord hit = args.hits.at[i];
  if (missed(hit)) return empty_texel();
  uint flags = args.scene.at[0].instances.at[hit.instance].flags;
  if ((flags & kInstanceCastsGi) == 0u) return empty_texel();
  float cross_section =
      perpendicular_area(args.projection, texel_middle(place.x, place.y, args.resolution),
                         args.resolution, hit.distance);
  LitPointRecord point = args.points.at[i];
  return seen_texel(point.position_ws, point.geometric_normal_ws, args.rays.at[i].direction_ws,
                    args.shaded.at[i].albedo_over_pi * args.irradiance.at[i], cross_section);
}

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID);
  if (place.x >= args.resolution || place.y >= args.resolution) return;
  int i = place.y * args.resolution + place.x;
  args.texels.at[i] = texel_at(place, i);
}
