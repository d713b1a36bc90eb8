// SPDX-License-Identifier: Apache-2.0
// The parts that all gathers have in common: finding a pixel, and writing its light.
layout(local_size_x = 32, local_size_y = 8) in;

#include "rsm/vulkan/device_passes.h"
#include "rsm/gather_texel.h"
#include "rsm/shaders/sub_image.glsl"
#include "shared/octahedral.h"
#include "shared/packing.h"
#include "shared/reorient_irradiance.h"

/// A pixel that gathers light.
struct Pixel {
  ivec2 at;
  vec3 position_ws;
  vec3 normal_ws;
};

/// This invocation's place in its sub-image; `first_row`: row of tiles of the first workgroups.
ivec2 own_place(int first_row) {
  return tile_of_group(kSubImages, first_row) + ivec2(gl_LocalInvocationID);
}

/// The pixel at a place of this workgroup's sub-image; false where the picture has none.
bool find_pixel(DeviceView view, ivec2 size, ivec2 place, out Pixel pixel) {
  pixel.at = pixel_of_sub_image(sub_image_of_group(kSubImages), place, kSubImages);
  pixel.position_ws = vec3(0.0f);
  pixel.normal_ws = vec3(0.0f);
  if (pixel.at.x >= size.x || pixel.at.y >= size.y) return false;
  int i = pixel.at.y * size.x + pixel.at.x;
  pixel.position_ws = view.positions_ws.at[i];
  pixel.normal_ws = view.normals_ws.at[i];
  return true;
}

/// Index of this invocation among all, workgroup after workgroup.
uint invocation_index() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  return group * gl_WorkGroupSize.x * gl_WorkGroupSize.y + gl_LocalInvocationIndex;
}

/// Writes the pixel's geometry to the mosaic, for blurs.
void write_guide(DeviceGuide guide, int place, Pixel pixel, float depth) {
  bool seen = depth > 0.0f && pixel.normal_ws != vec3(0.0f);
  guide.points.at[place] = vec4(pixel.position_ws, seen ? 1.0f / depth : 0.0f);
  guide.normals.at[place] = seen ? encode_unit_vector(pixel.normal_ws) : 0u;
}

/// Writes the pixel's light: to the picture, or to the mosaic in the form that can be blurred.
void finish_pixel(DeviceView view, GatherTarget target, ivec2 size, uint flags, Pixel pixel,
                  TexelLight gathered) {
  int i = pixel.at.y * size.x + pixel.at.x;
  vec3 light = gathered.light;
  if ((flags & kGatherDimmed) != 0u) light *= target.arrived.at[i];
  if ((flags & kGatherBlurred) == 0u) {
    target.picture.at[i] = light;
    return;
  }
  int place = mosaic_index(pixel.at, size, kSubImages);
  int plane = mosaic_places(size, kSubImages);
  write_guide(target.guide, place, pixel, view.depths.at[i]);
  vec3 means = reorientation(gathered.directions, pixel.normal_ws, luminance(light));
  target.light.at[place] = pack_upper_halves(light.x, means.x);
  target.light.at[place + plane] = pack_upper_halves(light.y, means.y);
  target.light.at[place + 2 * plane] = pack_upper_halves(light.z, means.z);
}
