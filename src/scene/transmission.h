// SPDX-License-Identifier: Apache-2.0
// Which materials stop rays, which ones transmit light, and which ones have layers or films.
#pragma once

#include "lambent/scene.h"

namespace lambent {

/// Whether some point of the material may transmit light (Material::transmission).
inline bool is_transmissive(const Material& material) {
  const bool dielectric =
      material.metallic < 1.0f || material.metallic_roughness_texture.texture >= 0;
  return material.transmission > 0.0f && dielectric && !material.unlit && !material.lambert;
}

/// Whether some point of the material may have a sheen or a clearcoat.
inline bool has_layers(const Material& material) {
  const bool any = material.clearcoat > 0.0f || material.sheen_color != glm::vec3(0.0f);
  return any && !material.unlit && !material.lambert;
}

/// Whether a thin film covers some point of the material.
inline bool has_film(const Material& material) {
  return material.iridescence > 0.0f && !material.unlit && !material.lambert;
}

/// Whether light may pass the material in part, so that it dims shadow rays.
inline bool dims_light(const Material& material) {
  return material.alpha_mode == AlphaMode::blend || is_transmissive(material);
}

/// Whether every ray that hits the material ends there.
inline bool stops_all_rays(const Material& material) {
  return material.alpha_mode == AlphaMode::opaque && !is_transmissive(material);
}

}  // namespace lambent
