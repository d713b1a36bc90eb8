// SPDX-License-Identifier: Apache-2.0
#ifndef LAMBENT_FIELD_TRANSPORT_PROBE_RAYS_H
#define LAMBENT_FIELD_TRANSPORT_PROBE_RAYS_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

// The mask of probe rays. It equals kRayOfProbe of raytracer.h, as the host asserts.
const uint kProbeRayMask = 4u;

LAMBENT_FN RayRecord probe_ray_record(vec3 origin_ws, vec3 direction_ws) {
  RayRecord ray = {origin_ws, 0.0f, direction_ws, uintBitsToFloat(kMissedDistanceBits),
                   kProbeRayMask};
  return ray;
}

LAMBENT_END
#endif
