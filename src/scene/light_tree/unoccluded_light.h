// SPDX-License-Identifier: Apache-2.0
// The light of a scene's lights at a point if nothing is in the way, without noise.
#pragma once

#include "scene/light_tree/light_tree.h"

namespace lambent {

/// Luminance that a white Lambert surface with this unit normal gets from the lights of a light
/// tree where nothing is in the way [W/(m^2 sr)]. In closed form, within a few percent: what is far
/// away counts as fewer, larger lights. Changes smoothly from place to place.
float unoccluded_light(const LightTree& tree, const EmissiveTriangles& emissive,
                       const glm::vec3& position_ws, const glm::vec3& normal_ws);

}  // namespace lambent
