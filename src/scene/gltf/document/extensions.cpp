// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/document/extensions.h"

#include <algorithm>
#include <cstring>

namespace lambent::gltf {
namespace {

constexpr const char* kIgnoredLobe = "materials are rendered without it";
constexpr const char* kBasisu = "KHR_texture_basisu";

// clang-format off
constexpr Extension kKnown[] = {
    {"EXT_mesh_gpu_instancing",             true,  nullptr},
    {"EXT_meshopt_compression",             true,  nullptr},
    {"EXT_texture_webp",                    true,  nullptr},
    {"KHR_animation_pointer",               true,  nullptr},
    {"KHR_draco_mesh_compression",          true,  nullptr},
    {"KHR_lights_punctual",                 true,  nullptr},
    {"KHR_materials_anisotropy",            false, kIgnoredLobe},
    {"KHR_materials_clearcoat",             true,  nullptr},
    {"KHR_materials_diffuse_transmission",  false, kIgnoredLobe},
    {"KHR_materials_dispersion",            false, "all colors are refracted alike"},
    {"KHR_materials_emissive_strength",     true,  nullptr},
    {"KHR_materials_ior",                   true,  nullptr},
    {"KHR_materials_iridescence",           true,  nullptr},
    {"KHR_materials_pbrSpecularGlossiness", true,  nullptr},
    {"KHR_materials_sheen",                 true,  nullptr},
    {"KHR_materials_specular",              true,  nullptr},
    {"KHR_materials_transmission",          true,  nullptr},
    {"KHR_materials_unlit",                 true,  nullptr},
    {"KHR_materials_variants",              false, "the default variant is shown"},
    {"KHR_materials_volume",                true,  nullptr},
    {"KHR_mesh_quantization",               true,  nullptr},
    {kBasisu,                               false, "textures use their plain image"},
    {"KHR_texture_transform",               true,  nullptr},
    {"KHR_xmp_json_ld",                     true,  nullptr},
};
// clang-format on

const Extension* find_known(const std::string& name) {
  const auto* known =
      std::lower_bound(std::begin(kKnown), std::end(kKnown), name,
                       [](const Extension& e, const std::string& n) { return e.name < n; });
  return known != std::end(kKnown) && known->name == name ? known : nullptr;
}

}  // namespace

std::span<const Extension> known_extensions() {
  return kKnown;
}

Expected<void> check_extensions(Document& document) {
  for (const std::string& name : document.model.extensionsRequired) {
    const Extension* known = find_known(name);
    if (name == kBasisu) {
      return document.fail_at("extensionsRequired",
                              "the file requires " + name +
                                  ": its textures exist only as KTX2, which is not read; convert "
                                  "them to PNG, JPEG or WebP and drop the extension");
    }
    if (!known || !known->required) {
      return document.fail_at("extensionsRequired", "the file requires the extension " + name +
                                                        ", which is not supported");
    }
  }
  for (const std::string& name : document.model.extensionsUsed) {
    const Extension* known = find_known(name);
    if (!known) {
      document.warn("Extension " + name + " is not known and was ignored.");
    } else if (known->note) {
      document.warn("Extension " + name + " is not supported: " + known->note + ".");
    }
  }
  return {};
}

}  // namespace lambent::gltf
