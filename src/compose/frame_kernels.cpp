// SPDX-License-Identifier: Apache-2.0
#include "compose/frame_kernels.h"

#include "shaders/camera_rays_comp.h"
#include "shaders/compose_comp.h"
#include "shaders/gather_rays_comp.h"
#include "shaders/gather_sum_comp.h"
#include "shaders/pixel_queries_comp.h"
#include "shaders/ray_queries_comp.h"
#include "shaders/replace_light_comp.h"
#include "shaders/view_geometry_comp.h"

namespace lambent {

FrameKernels::FrameKernels(const vulkan::Device& device)
    : camera_rays(device, shaders::camera_rays_comp(), "camera rays"),
      pixel_queries(device, shaders::pixel_queries_comp(), "pixel queries"),
      gather_rays(device, shaders::gather_rays_comp(), "gather rays"),
      ray_queries(device, shaders::ray_queries_comp(), "ray queries"),
      gather_sum(device, shaders::gather_sum_comp(), "gather sum"),
      replace_light(device, shaders::replace_light_comp(), "replace light"),
      view_geometry(device, shaders::view_geometry_comp(), "view geometry"),
      compose(device, shaders::compose_comp(), "compose") {}

FrameMemory::FrameMemory(const vulkan::Device& device)
    : pixel_shading(device), gather_shading(device), mapper(device), rsm(device) {}

}  // namespace lambent
