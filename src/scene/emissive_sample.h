// SPDX-License-Identifier: Apache-2.0
// An emissive triangle, as a light.
#ifndef LAMBENT_SCENE_EMISSIVE_SAMPLE_H
#define LAMBENT_SCENE_EMISSIVE_SAMPLE_H

#include "shared/layers.h"

LAMBENT_BEGIN

/// An emissive triangle.
struct EmitterRecord {
  uint instance;
  uint triangle;
  float area;         ///< World space [m^2].
  float probability;  ///< Of being drawn by power.
  vec3 corner_ws;     ///< Its first vertex [m], and from there to the two others.
  vec3 edge1_ws;
  vec3 edge2_ws;
};

LAMBENT_END
#endif
