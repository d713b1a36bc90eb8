// SPDX-License-Identifier: Apache-2.0
// Unlit materials, whose colour is shown as it is whatever the light.
#pragma once

#include <algorithm>

#include "lambent/scene.h"

namespace lambent {

/// Whether an instance has a material with Material::unlit, which then determines the exposure.
inline bool shows_unlit(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& placed) {
    return scene.materials[scene.meshes[placed.mesh].material].unlit;
  });
}

}  // namespace lambent
