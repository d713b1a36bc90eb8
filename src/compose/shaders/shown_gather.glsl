// SPDX-License-Identifier: Apache-2.0
// What pixels store of the light that shown surfaces gather.
#include "compose/gather/shown_gather_records.h"
#include "glossy/coat_path.h"

/// Stores that a pixel has gathered nothing.
void empty_shown_gather(ShownGatherRecord kept, uint pixel) {
  kept.gathered.at[pixel] = vec3(0.0f);
  kept.variance.at[pixel] = 0.0f;
  kept.excess.at[pixel] = vec3(0.0f);
  kept.looked_up.at[pixel] = vec3(0.0f);
}

/// See ShownGatherPixels::keep(). `looked_up`: irradiance by a lookup, read where `base` gathers
/// light. What it gathered is already there.
void keep_shown_gather(ShownGatherRecord kept, ShownBase base, vec3 weight, vec3 looked_up,
                       uint pixel) {
  kept.geometric_normals_ws.at[pixel] = base.geometric_normal_ws;
  if (base.indirect_albedo == vec3(0.0f)) {
    // The weight of what is not there may be no number
    kept.albedo.at[pixel] = vec3(0.0f);
    empty_shown_gather(kept, pixel);
    return;
  }
  kept.albedo.at[pixel] = weight * base.indirect_albedo;
  kept.looked_up.at[pixel] = base.gi_share * looked_up;
}
