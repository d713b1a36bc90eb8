// SPDX-License-Identifier: Apache-2.0
// Projections and shading of maps, for any tracer.
#pragma once

#include <vector>

#include "lambent/rsm.h"
#include "raytracing/shade_hits.h"

namespace lambent {

/// The projection of a light's map; see render_rsm().
RsmProjection fit_projection(const Scene& scene, const Light& light);

/// The projection of the map of what the camera sees.
RsmProjection camera_projection(const Camera& camera, float aspect);

/// The settings of direct light for the map of what the camera sees.
ShadeHitsSettings camera_shading(const RsmSettings& settings);

/// Fails as render_rsms() does.
Expected<void> check_map_request(const Camera& camera, float aspect, const RsmSettings& settings);

/// The public functions of these names, for valid arguments; `map` and `maps` reuse their memory.
void render_rsm(const World& world, const Light& light, const RsmSettings& settings,
                ReflectiveShadowMap& map);
void render_rsm(const World& world, const Camera& camera, float aspect, const RsmSettings& settings,
                ReflectiveShadowMap& map);
void render_rsms(const World& world, const Camera& camera, float aspect,
                 const RsmSettings& settings, std::vector<ReflectiveShadowMap>& maps);

}  // namespace lambent
