// SPDX-License-Identifier: Apache-2.0
// Allocation of rays in an array that all workgroups share. Workgroups allocate in the order in
// which they run, which differs from run to run, so that each invocation must remember where its
// rays are.
#ifndef LAMBENT_FIELD_LOOKUP_SHADERS_ALLOCATE_RAYS_GLSL
#define LAMBENT_FIELD_LOOKUP_SHADERS_ALLOCATE_RAYS_GLSL

#include "field/vulkan/device_arguments.h"

shared uint rays_of_group, first_of_group;

/// Allocates rays for this invocation, and returns the index of the first. All invocations of a
/// workgroup must call it.
uint allocate_rays(UintArray counter, uint rays) {
  if (gl_LocalInvocationIndex == 0u) rays_of_group = 0u;
  barrier();
  uint before = atomicAdd(rays_of_group, rays);
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    first_of_group = atomicAdd(counter.at[kRaysRequested], rays_of_group);
    atomicAdd(counter.at[kRaysTotal], rays_of_group);
  }
  barrier();
  return first_of_group + before;
}

#endif
