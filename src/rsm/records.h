// SPDX-License-Identifier: Apache-2.0
// Maps and what is gathered from them, as both languages read them.
#ifndef LAMBENT_RSM_RECORDS_H
#define LAMBENT_RSM_RECORDS_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// A texel of a map; as struct RsmTexel of lambent/rsm.h, which tells more.
struct RsmTexelRecord {
  vec3 position_ws;  ///< [m]
  float area;        ///< [m^2]; 0: it saw nothing.
  vec3 normal_ws;    ///< Unit; 0: it saw nothing.
  float softening;   ///< [m^2]
  vec3 flux;         ///< [W]; while it is gathered, over pi.
  float unused;      ///< Fills up 16 bytes.
};

LAMBENT_DEVICE_ARRAY(RsmTexelArray, RsmTexelRecord, 16)

/// RsmProjection::Kind
const uint kOrthographicMap = 0u;
const uint kPerspectiveMap = 1u;
const uint kOctahedralMap = 2u;

/// How a map's square is spread over what the light sees; as struct RsmProjection.
struct MapProjection {
  uint kind;
  vec3 origin_ws;         ///< [m]
  mat3 world_from_light;  ///< Orthonormal; looks along its -Z.
  vec2 half_extent;       ///< [m], or tangents of the half angles.
};

LAMBENT_END
#endif
