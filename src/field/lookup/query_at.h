// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/field.h"
#include "raytracing/direct_light.h"

namespace lambent {

/// The query of the field's light at a point that a ray found.
inline FieldQuery query_at(const LitPoint& point) {
  return {point.position_ws, point.normal_ws, point.to_viewer_ws, point.viewer_distance};
}

}  // namespace lambent
