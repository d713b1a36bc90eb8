// SPDX-License-Identifier: Apache-2.0
// The light of shadow maps in place of the field's share of it: what both backends do at a pixel,
// and the arguments of the device's kernel.
#ifndef LAMBENT_COMPOSE_RSM_REPLACE_LIGHT_H
#define LAMBENT_COMPOSE_RSM_REPLACE_LIGHT_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

/// The field's light at a pixel after another method has replaced a part of it.
LAMBENT_FN vec3 replaced_light(vec3 irradiance, vec3 added, vec3 subtracted_field) {
  return max(irradiance + added - subtracted_field, vec3(0.0f));
}

/// Replaces the light of pixels, see replaced_light().
struct ReplaceLightArguments {
  Vec3Array irradiance;
  Vec3Array subtracted_field;
  Vec3Array added;
  uint count;
  uint subtracts;  ///< 1: there is light to subtract.
};

LAMBENT_END
#endif
