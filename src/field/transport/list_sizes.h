// SPDX-License-Identifier: Apache-2.0
// The numbers of workgroups of kernels that work on a list of probes. The host or the device
// computes them, depending on which of them decides the length of the list.
#ifndef LAMBENT_FIELD_TRANSPORT_LIST_SIZES_H
#define LAMBENT_FIELD_TRANSPORT_LIST_SIZES_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Numbers of workgroups, as indirect dispatches read them.
struct GroupCounts {
  uint x;
  uint y;
  uint z;
};

// Shapes of a kernel's dispatch over a list of probes: over the rays, texels or gutter texels of
// each probe, in workgroups of eight by eight; one lane group per probe; over columns of a matrix
// product and blocks of probes; one lane per probe; one workgroup per probe; a launch of rays.
const uint kOverRays = 0u;
const uint kOverTexels = 1u;
const uint kOverIrradianceGutters = 2u;
const uint kOverDistanceGutters = 3u;
const uint kOverLaneGroups = 4u;
const uint kOverIrradianceBlocks = 5u;
const uint kOverDistanceBlocks = 6u;
const uint kOverLanes = 7u;
const uint kOverProbes = 8u;
const uint kOverLaunch = 9u;
const int kListShapes = 10;

/// A device's decision about a list.
struct ListState {
  GroupCounts over[kListShapes];  ///< Workgroups of the kernels that work on it, by shape.
  uint probes;
  uint texels;                ///< Irradiance texels of all probes of the list.
  uint largest_blend_weight;  ///< Bits of the largest blend weight of the list's probes.
};

/// From which list_groups() computes the workgroups for a list: `across` of them along x, and along
/// y one per `each` probes or blocks.
struct ListSize {
  uint across;  ///< Workgroups along x. 0: the list is along x instead, with one workgroup along y.
  uint each;    ///< Number of probes or blocks per workgroup.
  uint blocks;  ///< 1: `each` counts blocks; 0: it counts probes.
};

LAMBENT_FN GroupCounts list_groups(ListSize size, uint probes, uint blocks) {
  uint items = size.blocks != 0u ? blocks : probes;
  uint along = (items + size.each - 1u) / size.each;
  GroupCounts groups = {size.across, along, 1u};
  if (size.across == 0u) {
    groups.x = along;
    groups.y = 1u;
  }
  return groups;
}

LAMBENT_END
#endif
