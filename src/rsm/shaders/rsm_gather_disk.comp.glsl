// SPDX-License-Identifier: Apache-2.0
// Gathers texels of all maps around each pixel's projection: RsmPattern::disk.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rsm/shaders/gather_pixel.glsl"

layout(push_constant, scalar) uniform Push {
  DiskArguments args;
};

/// Index of texel `place` of a sub-map in the map's array.
uint texel_index(int resolution, ivec2 sub_map, ivec2 place) {
  ivec2 texel = pixel_of_sub_image(sub_map, place, args.sub_maps);
  bool rendered = (args.flags & kGatherRendered) != 0u;
  return uint(rendered ? texel.y * resolution + texel.x
                       : sub_map_texel(texel, resolution, args.sub_maps));
}

void gather_map(inout TexelLight sum, DiskMap map, Pixel pixel) {
  int n = args.sub_maps;
  ivec2 sub_map = sub_image_of(pixel.at, n);
  ivec2 size = ivec2(sub_image_size(map.resolution, sub_map.x, n),
                     sub_image_size(map.resolution, sub_map.y, n));
  vec2 middle = project_to_map(map.projection, pixel.position_ws, map.resolution);
  for (int k = 0; k < args.count; ++k) {
    // Sub-maps share out the disk's samples, and each represents all of them
    DiskSample disk = map.samples.at[sub_map_of(sub_map, n) * args.count + k];
    ivec2 place = nearest_in_sub_map(middle + disk.offset, sub_map, n);
    if (place.x < 0 || place.y < 0 || place.x >= size.x || place.y >= size.y) continue;
    RsmTexelRecord texel = map.texels.at[texel_index(map.resolution, sub_map, place)];
    texel = weigh_disk_texel(texel, disk.weight * float(n * n), n, args.softening);
    TexelSight sight = see_texel_record(pixel.position_ws, pixel.normal_ws, texel);
    gather_texel(sum, sight, texel);
    bool with_direction = (args.flags & kGatherBlurred) != 0u && k % kTexelsPerDirection == 0;
    if (with_direction) gather_direction(sum, sight, texel);
  }
}

void main() {
  Pixel pixel;
  ivec2 size = ivec2(args.width, args.height);
  if (!find_pixel(args.view, size, own_place(0), pixel)) return;
  TexelLight sum = {vec3(0.0f), vec3(0.0f)};
  for (int m = 0; m < args.map_count; ++m) gather_map(sum, args.maps.at[m], pixel);
  finish_pixel(args.view, args.target, size, args.flags, pixel, sum);
}
