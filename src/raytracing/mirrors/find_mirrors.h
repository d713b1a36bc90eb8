// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "lambent/scene.h"
#include "raytracing/mirrors/mirror_math.h"
#include "raytracing/surface_math.h"

namespace lambent {

/// Whether some of a material's surfaces may be mirrors. Textures can only lower the factors.
inline bool may_be_mirror(const Material& material) {
  if (material.lambert) return false;
  const bool textured = material.metallic_roughness_texture.texture >= 0;
  const float alpha = material.roughness * material.roughness;
  if (!textured && std::max(alpha, kMinGgxAlpha) >= kMinAlphaOfHits) return false;
  // A coat that reflects kMinCoatOfMirror of a surface's light is of half a metal at least, or of
  // something denser than glass
  const vec3 dielectric = coated_reflectance(vec3(0.0f), 0.0f, 1.0f, material.specular,
                                             material.specular_color, material.ior)
                              .f0;
  return material.metallic > 0.5f || luminance(dielectric) >= kMinMirrorReflectance;
}

inline bool has_mirrors(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), may_be_mirror);
}

}  // namespace lambent
