// SPDX-License-Identifier: Apache-2.0
// Clusters: eight lanes of a subgroup that share what they load. Workgroups have kGroupLanes lanes.
//
// Kernels that keep sums in arrays leave their loops over these by no `continue`: loops that cannot
// be unrolled whole have compilers keep the arrays in memory, which takes half as long again.
#ifndef LAMBENT_FIELD_TRANSPORT_SHADERS_LANE_GROUP_GLSL
#define LAMBENT_FIELD_TRANSPORT_SHADERS_LANE_GROUP_GLSL
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require

#include "field/vulkan/device_arguments.h"

const uint kLaneMask = uint(kLaneGroupSize - 1);

/// Of a workgroup.
const uint kLaneGroupsPerWorkgroup = uint(kGroupLanes / kLaneGroupSize);

int lane_in_group() {
  return int(gl_SubgroupInvocationID & kLaneMask);
}

/// Number of a cluster in its workgroup. By the place of its first lane there: a subgroup may be
/// narrower than its size is said to be.
uint lane_group_in_workgroup() {
  uint place = subgroupShuffle(gl_LocalInvocationIndex, gl_SubgroupInvocationID & ~kLaneMask);
  return place / uint(kLaneGroupSize);
}

/// What a lane of the cluster holds.
float from_lane(float value, int lane) {
  return subgroupShuffle(value, (gl_SubgroupInvocationID & ~kLaneMask) + uint(lane));
}

/// The sum over the cluster, for each of its lanes.
int lane_group_sum(int value) {
  for (uint step = 1u; step < uint(kLaneGroupSize); step *= 2u) {
    value += subgroupShuffle(value, gl_SubgroupInvocationID ^ step);
  }
  return value;
}

#endif
