// SPDX-License-Identifier: Apache-2.0
// The light that shown surfaces gather, in a device's memory.
#ifndef LAMBENT_COMPOSE_GATHER_SHOWN_GATHER_RECORDS_H
#define LAMBENT_COMPOSE_GATHER_SHOWN_GATHER_RECORDS_H

#include "denoise/denoise_records.h"

LAMBENT_BEGIN

/// See ShownGatherPixels. Addresses are 0 where no surface gathers light.
struct ShownGatherRecord {
  Vec3Array geometric_normals_ws;
  Vec3Array gathered;
  FloatArray variance;  ///< Written where a surface has several rays.
  Vec3Array excess;
  Vec3Array looked_up;
  Vec3Array albedo;
  Vec3Array filtered;
};

LAMBENT_END
#endif
