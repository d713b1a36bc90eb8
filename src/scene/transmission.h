// SPDX-License-Identifier: Apache-2.0
// Which materials stop rays, and which of them let light through.
#pragma once

#include "lambent/scene.h"

namespace lambent {

/// Whether some point of the material may let light through its surface (Material::transmission).
inline bool lets_light_through(const Material& material) {
  const bool dielectric =
      material.metallic < 1.0f || material.metallic_roughness_texture.texture >= 0;
  return material.transmission > 0.0f && dielectric && !material.unlit && !material.lambert;
}

/// Whether every ray that meets the material ends there.
inline bool stops_all_rays(const Material& material) {
  return material.alpha_mode == AlphaMode::opaque && !lets_light_through(material);
}

}  // namespace lambent
