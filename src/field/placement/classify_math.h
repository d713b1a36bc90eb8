// SPDX-License-Identifier: Apache-2.0
// Based on: Majercik et al., "Scaling Probe-Based Real-Time Dynamic Global Illumination for
// Production", JCGT 10(2), 2021, sec. 4. The formula of classification that C++ and GLSL share.
#ifndef LAMBENT_FIELD_PLACEMENT_CLASSIFY_MATH_H
#define LAMBENT_FIELD_PLACEMENT_CLASSIFY_MATH_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Where more than this fraction of a probe's rays hit sides that bound solid matter, the probe
/// stands inside geometry and lights nothing. JCGT 10(2) 2021, sec. 4.
const float kBackFaceThreshold = 0.25f;

/// Whether a probe stands inside geometry: 1 or 0.
LAMBENT_FN uint is_inside_geometry(int back_faces, int rays) {
  return float(back_faces) > kBackFaceThreshold * float(rays) ? 1u : 0u;
}

LAMBENT_END
#endif
