// SPDX-License-Identifier: Apache-2.0
// Scenes as binary glTF 2.0 files.
//
// Properties without a counterpart in glTF are stored so that load_scene restores them:
//   - Material::lambert becomes KHR_materials_specular with specularFactor 0 on a non-metal: no
//   coat at all
//   - an instance's flags of global illumination become "lambent_casts_gi" and so on in the
//   extras of its node
//   - the constant sky becomes "lambent_sky_radiance": [r, g, b] in the extras of the glTF scene
#pragma once

#include <string>

#include "lambent/scene.h"
#include "scenes/animation.h"

namespace lambent::scenes {

/// The bytes of a self-contained .glb file, with images as PNG. Fails on properties that glTF
/// cannot represent: environment maps, and Lambert materials with a metallic-roughness texture.
Expected<std::string> encode_glb(const Scene& scene, const Animations& animations = {});

/// Writes encode_glb() to a file, as a whole or not at all. Returns the number of bytes.
Expected<std::size_t> write_glb(const Scene& scene, const std::string& path,
                                const Animations& animations = {});

}  // namespace lambent::scenes
