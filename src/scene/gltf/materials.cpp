// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/materials.h"

#include <algorithm>
#include <cmath>

#include "scene/limits.h"

namespace lambent::gltf {
namespace {

constexpr Texels kColor = Texels::color, kData = Texels::data, kNormals = Texels::normals;

// Reads one material; errors and warnings name it.
class MaterialReader {
 public:
  MaterialReader(Document& document, const tinygltf::Material& source, std::string place,
                 TextureLibrary& textures)
      : document_(document), source_(source), place_(std::move(place)), textures_(textures) {}

  Expected<Material> read(const LoadOptions& options) {
    material_.name = source_.name;
    material_.lambert = options.lambert;
    material_.double_sided = source_.doubleSided;
    LAMBENT_CHECK(read_alpha());
    // Files that bring both mean the older model, where it is understood, to be taken
    constexpr const char* kOlderModel = "KHR_materials_pbrSpecularGlossiness";
    if (const auto* older = find_extension(source_.extensions, kOlderModel)) {
      LAMBENT_CHECK(read_specular_glossiness(*older));
    } else {
      LAMBENT_CHECK(read_metallic_roughness());
      LAMBENT_CHECK(read_specular());
      read_ior();
    }
    LAMBENT_CHECK(read_emission());
    LAMBENT_CHECK(read_transmission());
    read_volume();
    LAMBENT_CHECK(read_clearcoat(options));
    LAMBENT_CHECK(read_sheen());
    LAMBENT_CHECK(read_film());
    if (options.normal_maps) {
      LAMBENT_CHECK(take(source_.normalTexture, kNormals, material_.normal_texture));
      material_.normal_scale = static_cast<float>(source_.normalTexture.scale);
    }
    material_.unlit = find_extension(source_.extensions, "KHR_materials_unlit") != nullptr;
    // occlusionTexture is ignored on purpose, since global illumination computes occlusion
    return std::move(material_);
  }

 private:
  template <class TextureInfo>
  Expected<void> take(const TextureInfo& info, Texels texels, TextureView& view) {
    if (info.index < 0) return {};
    LAMBENT_TRY(made, textures_.view(info.index, info.texCoord, info.extensions, texels, place_));
    view = made;
    return {};
  }

  // A textureInfo inside an extension, which tinygltf leaves unparsed.
  static tinygltf::TextureInfo info_of(const tinygltf::Value& extension, const char* key) {
    tinygltf::TextureInfo info;
    if (!extension.Has(key)) return info;
    const tinygltf::Value& source = extension.Get(key);
    info.index = integer_or(source, "index", -1);
    info.texCoord = integer_or(source, "texCoord", 0);
    if (source.Has("extensions")) {
      info.extensions = source.Get("extensions").Get<tinygltf::Value::Object>();
    }
    return info;
  }
  Expected<void> take(const tinygltf::Value& extension, const char* key, Texels texels,
                      TextureView& view) {
    return take(info_of(extension, key), texels, view);
  }

  Texels base_texels() const {
    return material_.alpha_mode == AlphaMode::opaque ? kColor : Texels::covering_color;
  }

  void set_base_color(int channel, double value) {
    const auto factor = static_cast<float>(value);
    material_.base_color[channel] = std::clamp(factor, 0.0f, 1.0f);
    document_.repaired("base colors were clamped to 0 to 1",
                       factor == material_.base_color[channel] ? 0 : 1, place_);
  }

  Expected<void> read_metallic_roughness() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    for (int k = 0; k < 4 && k < static_cast<int>(pbr.baseColorFactor.size()); ++k) {
      set_base_color(k, pbr.baseColorFactor[k]);
    }
    material_.metallic = static_cast<float>(pbr.metallicFactor);
    material_.roughness = static_cast<float>(pbr.roughnessFactor);
    LAMBENT_CHECK(take(pbr.baseColorTexture, base_texels(), material_.base_color_texture));
    return take(pbr.metallicRoughnessTexture, kData, material_.metallic_roughness_texture);
  }

  Expected<void> read_emission() {
    glm::dvec3 emission = vec3_of(source_.emissiveFactor, glm::vec3(0.0f));
    if (glm::any(glm::lessThan(emission, glm::dvec3(0.0)))) {
      document_.repaired("negative emissive factors were set to 0", 1, place_);
      emission = glm::max(emission, glm::dvec3(0.0));
    }
    const auto* strength = find_extension(source_.extensions, "KHR_materials_emissive_strength");
    if (strength) {
      emission *= number_or(*strength, "emissiveStrength", 1.0);
    }
    const bool too_bright = glm::any(glm::greaterThan(emission, glm::dvec3(kMaxRadiance)));
    document_.repaired("emissions were reduced to 1e10 W/(m^2 sr)", too_bright ? 1 : 0, place_);
    material_.emission = limited(emission, kMaxRadiance);
    LAMBENT_CHECK(take(source_.emissiveTexture, kColor, material_.emission_texture));
    // A map restricts emission to lamps and screens, so without it the whole surface would glow
    const bool lost = source_.emissiveTexture.index >= 0 && material_.emission_texture.texture < 0;
    if (lost) material_.emission = glm::vec3(0.0f);
    return {};
  }

  Expected<void> read_specular() {
    const auto* specular = find_extension(source_.extensions, "KHR_materials_specular");
    if (!specular) return {};
    material_.specular = static_cast<float>(number_or(*specular, "specularFactor", 1.0));
    if (specular->Has("specularColorFactor")) {
      const tinygltf::Value& color = specular->Get("specularColorFactor");
      for (int k = 0; k < 3; ++k) {
        material_.specular_color[k] =
            std::clamp(static_cast<float>(color.Get(k).GetNumberAsDouble()), 0.0f, kMaxFactor);
      }
    }
    LAMBENT_CHECK(take(*specular, "specularTexture", kData, material_.specular_texture));
    return take(*specular, "specularColorTexture", kColor, material_.specular_color_texture);
  }

  // An older model of materials: a dielectric whose reflectance at normal incidence is the specular
  // color, which is what an index of refraction without bound makes of it.
  Expected<void> read_specular_glossiness(const tinygltf::Value& model) {
    material_.metallic = 0.0f;
    material_.ior = kMaxFactor;
    if (model.Has("diffuseFactor")) {
      const tinygltf::Value& diffuse = model.Get("diffuseFactor");
      for (int k = 0; k < 4; ++k) set_base_color(k, diffuse.Get(k).GetNumberAsDouble());
    }
    if (model.Has("specularFactor")) {
      const tinygltf::Value& color = model.Get("specularFactor");
      for (int k = 0; k < 3; ++k) {
        const auto factor = static_cast<float>(color.Get(k).GetNumberAsDouble());
        material_.specular_color[k] = std::clamp(factor, 0.0f, 1.0f);
      }
    }
    LAMBENT_CHECK(take(model, "diffuseTexture", base_texels(), material_.base_color_texture));
    LAMBENT_CHECK(
        take(model, "specularGlossinessTexture", kColor, material_.specular_color_texture));
    return read_glossiness(model);
  }

  Expected<void> read_glossiness(const tinygltf::Value& model) {
    const auto factor = static_cast<float>(number_or(model, "glossinessFactor", 1.0));
    material_.roughness = 1.0f - factor;
    const tinygltf::TextureInfo info = info_of(model, "specularGlossinessTexture");
    if (info.index < 0 || factor <= 0.0f) return {};
    LAMBENT_TRY(made, textures_.view_of_glossiness(info.index, info.texCoord, info.extensions,
                                                   factor, place_));
    material_.metallic_roughness_texture = made;
    if (made.texture >= 0) material_.roughness = 1.0f;
    return {};
  }

  Expected<void> read_transmission() {
    const auto* transmission = find_extension(source_.extensions, "KHR_materials_transmission");
    if (!transmission) return {};
    material_.transmission =
        static_cast<float>(number_or(*transmission, "transmissionFactor", 0.0));
    return take(*transmission, "transmissionTexture", kData, material_.transmission_texture);
  }

  // Rays determine the thickness of a volume; the factor only distinguishes volumes from panes.
  void read_volume() {
    const auto* volume = find_extension(source_.extensions, "KHR_materials_volume");
    if (!volume || number_or(*volume, "thicknessFactor", 0.0) <= 0.0) return;
    material_.bounds_volume = true;
    if (!volume->Has("attenuationDistance") || !volume->Has("attenuationColor")) return;
    const double distance = number_or(*volume, "attenuationDistance", 0.0);
    const tinygltf::Value& color = volume->Get("attenuationColor");
    bool limited = !(distance > 0.0);
    for (int k = 0; k < 3 && !limited; ++k) {
      const double left = color.Get(k).GetNumberAsDouble();
      // A color of 0 means infinite absorption
      const double absorption = left > 0.0 ? -std::log(std::min(left, 1.0)) / distance : kMaxFactor;
      material_.absorption[k] = static_cast<float>(std::min<double>(absorption, kMaxFactor));
    }
    document_.repaired("volumes of attenuation distance 0 were taken for clear", limited ? 1 : 0,
                       place_);
  }

  Expected<void> read_clearcoat(const LoadOptions& options) {
    const auto* clearcoat = find_extension(source_.extensions, "KHR_materials_clearcoat");
    if (!clearcoat) return {};
    material_.clearcoat = static_cast<float>(number_or(*clearcoat, "clearcoatFactor", 0.0));
    material_.clearcoat_roughness =
        static_cast<float>(number_or(*clearcoat, "clearcoatRoughnessFactor", 0.0));
    LAMBENT_CHECK(take(*clearcoat, "clearcoatTexture", kData, material_.clearcoat_texture));
    LAMBENT_CHECK(take(*clearcoat, "clearcoatRoughnessTexture", kData,
                       material_.clearcoat_roughness_texture));
    if (!options.normal_maps || !clearcoat->Has("clearcoatNormalTexture")) return {};
    material_.clearcoat_normal_scale =
        static_cast<float>(number_or(clearcoat->Get("clearcoatNormalTexture"), "scale", 1.0));
    return take(*clearcoat, "clearcoatNormalTexture", kNormals, material_.clearcoat_normal_texture);
  }

  Expected<void> read_sheen() {
    const auto* sheen = find_extension(source_.extensions, "KHR_materials_sheen");
    if (!sheen) return {};
    if (sheen->Has("sheenColorFactor")) {
      const tinygltf::Value& color = sheen->Get("sheenColorFactor");
      bool clamped = false;
      for (int k = 0; k < 3; ++k) {
        const double factor = color.Get(k).GetNumberAsDouble();
        material_.sheen_color[k] = static_cast<float>(std::clamp(factor, 0.0, 1.0));
        clamped = clamped || factor < 0.0 || factor > 1.0;
      }
      document_.repaired("sheen colors were clamped to 0 to 1", clamped ? 1 : 0, place_);
    }
    material_.sheen_roughness = static_cast<float>(number_or(*sheen, "sheenRoughnessFactor", 0.0));
    LAMBENT_CHECK(take(*sheen, "sheenColorTexture", kColor, material_.sheen_color_texture));
    return take(*sheen, "sheenRoughnessTexture", kData, material_.sheen_roughness_texture);
  }

  Expected<void> read_film() {
    const auto* film = find_extension(source_.extensions, "KHR_materials_iridescence");
    if (!film) return {};
    const auto number = [film](const char* name, float fallback) {
      return static_cast<float>(number_or(*film, name, fallback));
    };
    material_.iridescence = number("iridescenceFactor", material_.iridescence);
    material_.iridescence_ior = number("iridescenceIor", material_.iridescence_ior);
    material_.iridescence_thickness_min =
        number("iridescenceThicknessMinimum", material_.iridescence_thickness_min);
    material_.iridescence_thickness_max =
        number("iridescenceThicknessMaximum", material_.iridescence_thickness_max);
    LAMBENT_CHECK(take(*film, "iridescenceTexture", kData, material_.iridescence_texture));
    return take(*film, "iridescenceThicknessTexture", kData,
                material_.iridescence_thickness_texture);
  }

  Expected<void> read_alpha() {
    material_.alpha_cutoff = static_cast<float>(source_.alphaCutoff);
    if (source_.alphaMode == "OPAQUE") {
      material_.alpha_mode = AlphaMode::opaque;
    } else if (source_.alphaMode == "MASK") {
      material_.alpha_mode = AlphaMode::mask;
    } else if (source_.alphaMode == "BLEND") {
      material_.alpha_mode = AlphaMode::blend;
    } else {
      return document_.fail_at(place_ + ".alphaMode", "must be OPAQUE, MASK or BLEND");
    }
    return {};
  }

  void read_ior() {
    const auto* extension = find_extension(source_.extensions, "KHR_materials_ior");
    if (!extension) return;
    material_.ior = static_cast<float>(number_or(*extension, "ior", material_.ior));
    if (material_.ior >= 1.0f) return;
    // 0 asks for F0 = 1, as materials converted from specular-glossiness do
    if (material_.ior == 0.0f) {
      material_.ior = kMaxFactor;
      return;
    }
    document_.repaired("indices of refraction below 1 were set to 1", 1, place_);
    material_.ior = 1.0f;
  }

  Document& document_;
  const tinygltf::Material& source_;
  std::string place_;
  TextureLibrary& textures_;
  Material material_;
};

}  // namespace

Expected<std::vector<Material>> import_materials(Document& document, const LoadOptions& options,
                                                 TextureLibrary& textures) {
  std::vector<Material> materials;
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
    MaterialReader reader(document, document.model.materials[i], entry("materials", i), textures);
    LAMBENT_TRY(material, reader.read(options));
    materials.push_back(std::move(material));
  }
  Material fallback;
  fallback.name = "default";
  fallback.lambert = options.lambert;
  materials.push_back(fallback);
  return materials;
}

}  // namespace lambent::gltf
