// SPDX-License-Identifier: Apache-2.0
// Maps, in the form that C++ and GLSL share.
#ifndef LAMBENT_RSM_RECORDS_H
#define LAMBENT_RSM_RECORDS_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// A texel of a map; see RsmTexel in lambent/rsm.h.
struct RsmTexelRecord {
  vec3 position_ws;  ///< [m]
  float area;        ///< [m^2]; 0: its ray hit nothing.
  vec3 normal_ws;    ///< Unit; 0: its ray hit nothing.
  float softening;   ///< [m^2]
  vec3 flux;         ///< [W]; over pi while it is gathered.
  float unused;      ///< Padding to a multiple of 16 bytes.
};

LAMBENT_DEVICE_ARRAY(RsmTexelArray, RsmTexelRecord, 16)

/// Values of RsmProjection::Kind.
const uint kOrthographicMap = 0u;
const uint kPerspectiveMap = 1u;
const uint kOctahedralMap = 2u;

/// The projection of a map's square; see RsmProjection.
struct MapProjection {
  uint kind;
  vec3 origin_ws;         ///< [m]
  mat3 world_from_light;  ///< Orthonormal; the light looks along its -Z.
  vec2 half_extent;       ///< [m], or tangents of the half angles.
};

LAMBENT_END
#endif
