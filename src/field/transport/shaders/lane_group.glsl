// SPDX-License-Identifier: Apache-2.0
// Lane groups: eight lanes of a subgroup that share what they load. Workgroups have kGroupLanes
// lanes.
//
// Kernels with sums in arrays have no `continue` in their loops over these arrays. It would prevent
// compilers from unrolling the loops completely; the arrays would then be in memory instead of
// registers, which takes half as long again.
#ifndef LAMBENT_FIELD_TRANSPORT_SHADERS_LANE_GROUP_GLSL
#define LAMBENT_FIELD_TRANSPORT_SHADERS_LANE_GROUP_GLSL
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require

#include "field/vulkan/device_arguments.h"

const uint kLaneMask = uint(kLaneGroupSize - 1);

/// Lane groups of a workgroup.
const uint kLaneGroupsPerWorkgroup = uint(kGroupLanes / kLaneGroupSize);

/// Index of this lane in its lane group.
int lane_in_group() {
  return int(gl_SubgroupInvocationID & kLaneMask);
}

/// Index of this lane's group in its workgroup. It follows from the index of the group's first
/// lane, because a subgroup may hold fewer lanes than its size says.
uint lane_group_in_workgroup() {
  uint place = subgroupShuffle(gl_LocalInvocationIndex, gl_SubgroupInvocationID & ~kLaneMask);
  return place / uint(kLaneGroupSize);
}

/// The value that another lane of the group holds.
float from_lane(float value, int lane) {
  return subgroupShuffle(value, (gl_SubgroupInvocationID & ~kLaneMask) + uint(lane));
}

/// The sum over the lanes of the group. Each of them receives it.
int lane_group_sum(int value) {
  for (uint step = 1u; step < uint(kLaneGroupSize); step *= 2u) {
    value += subgroupShuffle(value, gl_SubgroupInvocationID ^ step);
  }
  return value;
}

#endif
