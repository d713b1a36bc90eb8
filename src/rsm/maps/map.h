// SPDX-License-Identifier: Apache-2.0
// How maps are laid over the scene, and shaded, whatever traces them.
#pragma once

#include "lambent/rsm.h"
#include "raytracing/shade_hits.h"

namespace lambent {

/// The projection of a light's map: see render_rsm.
RsmProjection fit_projection(const Scene& scene, const Light& light);

/// Of the map of what the camera sees.
RsmProjection camera_projection(const Camera& camera, float aspect);

/// How what the camera sees is lit for its map.
ShadeHitsSettings camera_shading(const RsmSettings& settings);

}  // namespace lambent
