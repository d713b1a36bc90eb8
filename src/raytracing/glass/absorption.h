// SPDX-License-Identifier: Apache-2.0
// What the matter of a volume absorbs of the light that passes it: the law of Beer and Lambert, for
// KHR_materials_volume.
#ifndef LAMBENT_RAYTRACING_GLASS_ABSORPTION_H
#define LAMBENT_RAYTRACING_GLASS_ABSORPTION_H

#include "shared/lang.h"

LAMBENT_BEGIN

/// Transmittance of a path through a volume. `absorption` [1/m], `distance` [m].
LAMBENT_FN vec3 volume_transmittance(vec3 absorption, float distance) {
  return exp(-absorption * distance);
}

/// What the boundary of a volume, met at a distance [m], adds to the optical depth of a straight
/// ray. A volume is entered and left: the difference of the distances is the path through it.
LAMBENT_FN vec3 depth_at_boundary(vec3 absorption, float distance, bool enters) {
  return absorption * (enters ? -distance : distance);
}

/// Transmittance of a straight ray, from the sum of depth_at_boundary(). A negative sum, of a ray
/// that ends within a volume, absorbs nothing.
LAMBENT_FN vec3 depth_transmittance(vec3 optical_depth) {
  return exp(-max(optical_depth, vec3(0.0f)));
}

LAMBENT_END
#endif
