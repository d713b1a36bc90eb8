// SPDX-License-Identifier: Apache-2.0
// Room for rays that invocations ask, in an array that all groups fill. Groups take theirs in the
// order in which they come, which differs from time to time: each invocation must know its own.
#ifndef LAMBENT_FIELD_LOOKUP_SHADERS_ALLOCATE_RAYS_GLSL
#define LAMBENT_FIELD_LOOKUP_SHADERS_ALLOCATE_RAYS_GLSL

#include "field/vulkan/device_arguments.h"

shared uint rays_of_group, first_of_group;

/// Counts an invocation's rays. Returns the place of the first. All of the group must call it.
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
