// SPDX-License-Identifier: Apache-2.0
// Scenes as binary glTF 2.0 files.
//
// What has no place in glTF is kept where load_scene finds it again:
//   - Material::lambert becomes KHR_materials_specular with specularFactor 0 on a non-metal: no
//   coat at all
//   - what an instance says of global illumination becomes "lambent_casts_gi" and the like in the
//   extras of its node
//   - the constant sky becomes "lambent_sky_radiance": [r, g, b] in the extras of the glTF scene
#pragma once

#include <string>

#include "lambent/scene.h"
#include "scenes/animation.h"

namespace lambent::scenes {

/// The bytes of a .glb file with everything in it, images as PNG. Fails on what glTF cannot hold:
/// environment maps, and Lambert materials with a metallic-roughness texture.
Expected<std::string> encode_glb(const Scene& scene, const Animations& animations = {});

/// encode_glb to a file, all or nothing. Returns the bytes written.
Expected<std::size_t> write_glb(const Scene& scene, const std::string& path,
                                const Animations& animations = {});

}  // namespace lambent::scenes
