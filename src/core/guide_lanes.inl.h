// SPDX-License-Identifier: Apache-2.0
// The guide of kLanes pixels in registers, by which kernels over a picture of planes
// (core/cross_bilateral.h) compare pixels. Without an include guard, like lanes.inl.h.
#include "core/lanes.inl.h"

/// Positions [m] and unit normals of pixels.
struct GuideLanes {
  Lanes x, y, z, nx, ny, nz;
};

LAMBENT_FORCE_INLINE void load_guide(GuideLanes& lanes, const ConstPlanes& guide, int i) {
  load(lanes.x, guide.at(kPositionPlane) + i);
  load(lanes.y, guide.at(kPositionPlane + 1) + i);
  load(lanes.z, guide.at(kPositionPlane + 2) + i);
  load(lanes.nx, guide.at(kNormalPlane) + i);
  load(lanes.ny, guide.at(kNormalPlane + 1) + i);
  load(lanes.nz, guide.at(kNormalPlane + 2) + i);
}
