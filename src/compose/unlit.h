// SPDX-License-Identifier: Apache-2.0
// Materials whose colour is to be seen as it is, whatever the light.
#pragma once

#include <algorithm>

#include "lambent/scene.h"

namespace lambent {

/// Whether an instance has a material of Material::unlit: its exposure then comes first.
inline bool shows_unlit(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& placed) {
    return scene.materials[scene.meshes[placed.mesh].material].unlit;
  });
}

}  // namespace lambent
