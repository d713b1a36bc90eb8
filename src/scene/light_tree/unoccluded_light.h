// SPDX-License-Identifier: Apache-2.0
// The unoccluded light of a scene's lights at a point, without noise.
#pragma once

#include "scene/light_tree/light_tree.h"

namespace lambent {

/// Radiance of a white Lambert surface with this unit normal under the unoccluded lights of a
/// light tree [W/(m^2 sr)]. In closed form, within a few percent: clusters of distant lights count
/// as one light. Continuous in the position.
glm::vec3 unoccluded_light(const LightTree& tree, const EmissiveTriangles& emissive,
                           const glm::vec3& position_ws, const glm::vec3& normal_ws);

}  // namespace lambent
