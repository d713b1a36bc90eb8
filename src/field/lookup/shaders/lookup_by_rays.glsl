// SPDX-License-Identifier: Apache-2.0
// The lookup of the irradiance field with visibility by rays that are traced at once. The includer
// provides what field/lookup/lookup.inl.h asks for, includes that, and has
//   uvec2 fetch_cell_visibility(int lowest)
//       the visibility between the corners of the cell whose lowest probe this is
//   bool field_occluded(vec3 origin_ws, vec3 direction_ws, float distance)
//       whether a ray hits anything nearer than this [m]
#ifndef LAMBENT_FIELD_LOOKUP_SHADERS_LOOKUP_BY_RAYS_GLSL
#define LAMBENT_FIELD_LOOKUP_SHADERS_LOOKUP_BY_RAYS_GLSL

#include "field/lookup/visibility_math.h"
#include "field/lookup/visibility.inl.h"

/// The weights of the corners around a point. With `exact`, all corners are tested with rays;
/// otherwise only those whose visibility the distances leave in doubt.
CornerWeights seen_corners(LookupGrid volume, LookupCell cell, vec3 position_ws, vec3 normal_ws,
                           bool exact) {
  CornerWeights by_distances = corner_weights(volume, cell, position_ws, normal_ws);
  float total = sum_of_weights(by_distances);

  // Find the corners that count as hidden without a ray, and those to test with one
  CornerWeights corners = by_distances;
  uvec2 cell_visibility = all_visible();
  VisibilityMask mask = VisibilityMask(0u, 0u);
  if (exact) {
    corners = visible_corners(volume, cell, corners, position_ws, normal_ws);
    mask.tested = weighed_corners(corners);
  } else {
    cell_visibility = fetch_cell_visibility(probe_index(volume.grid, cell.cell.base));
    mask = visibility_mask(corners, cell_visibility, total);
    hide_corners(corners, mask.hidden);
  }

  // Trace the rays of this lookup
  uint hidden = 0u;
  for (uint tested = mask.tested; tested != 0u; tested &= tested - 1u) {
    int corner = findLSB(tested);
    RayRecord ray = corner_ray(volume.grid, cell, corner);
    if (field_occluded(ray.origin_ws, ray.direction_ws, ray.t_max)) hidden |= 1u << uint(corner);
  }
  if (!exact) return tested_weights(corners, hidden, cell_visibility, total);
  hide_corners(corners, hidden);
  // Where no probe is visible, the weights by distances stay
  return sum_of_weights(corners) > 0.0f ? corners : by_distances;
}

/// lookup_irradiance() with these weights.
vec3 lookup_irradiance_by_rays(int volumes, vec3 position_ws, vec3 normal_ws, vec3 to_viewer_ws,
                               bool exact) {
  vec4 answer = vec4(0.0f);
  for (int volume = 0; volume < volumes && answer.w < 1.0f; ++volume) {
    ProbeGrid grid = fetch_grid(volume);
    float volume_weight = volume_share(grid, volume, volumes, position_ws) * (1.0f - answer.w);
    if (volume_weight <= 0.0f) continue;
    LookupGrid looked_up = lookup_grid(grid);
    LookupCell cell = lookup_cell(looked_up, position_ws, normal_ws, to_viewer_ws, infinity());
    CornerWeights corners = seen_corners(looked_up, cell, position_ws, normal_ws, exact);
    answer += irradiance_of_corners(grid, volume, volume_weight, cell, corners, position_ws,
                                    normal_ws);
  }
  return answer.w > 0.0f ? vec3(answer) / answer.w : vec3(0.0f);
}

#endif
