// SPDX-License-Identifier: Apache-2.0
// How many groups kernels have that work on a list of probes, whoever knows how long it is.
#ifndef LAMBENT_FIELD_TRANSPORT_LIST_SIZES_H
#define LAMBENT_FIELD_TRANSPORT_LIST_SIZES_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// A number of groups, as indirect dispatches read it.
struct GroupCounts {
  uint x;
  uint y;
  uint z;
};

// What kernels run over: each probe's rays, texels, or texels of gutters, eight by eight; clusters
// of lanes, one a probe; columns of a matrix product times blocks of probes; lanes, one a probe;
// groups, one a probe; a launch of rays.
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

/// What a device decided of a list.
struct ListState {
  GroupCounts over[kListShapes];  ///< Groups of the kernels that work on it, by shape.
  uint probes;
  uint texels;  ///< Of their irradiance.
  uint
      largest_blend_weight;  ///< Bits of the largest share that any of them takes of its new light.
};

/// Groups across, and how many of the list's probes, or of its blocks, one takes.
struct ListSize {
  uint across;  ///< 0: the list itself lies across.
  uint each;
  uint blocks;  ///< 1: blocks.
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
