// SPDX-License-Identifier: Apache-2.0
// Workgroups process a row of a sub-image, so that the rays of neighbours go to the same lights.
layout(local_size_x = 64) in;

#include "rsm/shaders/sub_image.glsl"
#include "rsm/vulkan/device_direct.h"

/// This invocation's pixel of a band; it may lie outside.
ivec2 own_pixel() {
  return pixel_of_sub_image(sub_image_of_group(kSubImages),
                            tile_of_group(kSubImages, 0) + ivec2(gl_LocalInvocationID), kSubImages);
}

/// Index of this invocation among all.
uint invocation_index() {
  return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
         gl_LocalInvocationIndex;
}

uint invocation_count() {
  return gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
}
