// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, sec. 5 "Properties Reference", and the README of
// each extension. One row per property; properties that are not listed are not read.
#pragma once

#include "scene/limits.h"

namespace lambent::gltf {

enum class Kind {
  object,          // of the shape `of`
  list,            // of objects of the shape `of`
  index,           // into the array at the JSON pointer `of`
  indices,         // a list of such
  attributes,      // an object whose members are such indices
  attribute_sets,  // a list of such objects
  ids,             // an object whose members are whole numbers
  whole,           // an integer from `low` to `high`
  number,          // from `low` to `high`
  factor,          // the same, but one that is out of range is brought into it
  reach,           // a number above 0; others are removed
  numbers,         // a list of `high` finite numbers; any number of them where `high` is 0. Their
                   // absolute values are at most `low`, where that is not 0
  string,
  strings,
  boolean,
};

struct Rule {
  const char* shape;
  const char* key;
  Kind kind;
  const char* of = "";
  double low = 0.0;
  double high = 0.0;
  bool required = false;
};

inline constexpr double kAnyInt = 2147483647.0;  // Fits the 32-bit integers of the parsed model.
inline constexpr double kAnySize = 9007199254740991.0;  // 2^53 - 1: largest exact integer in JSON.
inline constexpr double kAnyFloat = 3.0e38;             // Fits a 32-bit float.
inline constexpr double kTiny = 1e-30;                  // "Greater than zero".
inline constexpr double kQuarterTurn =
    1.5707964;  // pi/2 rounded up to what files hold as 32-bit floats.
inline constexpr bool kRequired = true;
inline constexpr double kSmallestFov = 1e-3;  // kMinFov before it is rounded to a float.
// Radians, but some exporters write degrees, which are repaired.
inline constexpr double kLargestFov = 179.9;

inline constexpr Rule kRules[] = {
    {"root", "asset", Kind::object, "asset", 0, 0, kRequired},
    {"asset", "version", Kind::string, "", 0, 0, kRequired},
    {"asset", "minVersion", Kind::string},
    {"asset", "generator", Kind::string},
    {"root", "extensionsUsed", Kind::strings},
    {"root", "extensionsRequired", Kind::strings},
    {"root", "scene", Kind::index, "/scenes"},
    {"root", "scenes", Kind::list, "scene"},
    {"scene", "nodes", Kind::indices, "/nodes"},

    {"root", "buffers", Kind::list, "buffer"},
    {"buffer", "byteLength", Kind::whole, "", 1, kAnySize, kRequired},
    {"buffer", "uri", Kind::string},
    {"buffer", "extensions", Kind::object, "bufferExtensions"},
    {"bufferExtensions", "EXT_meshopt_compression", Kind::object, "meshoptBuffer"},
    {"meshoptBuffer", "fallback", Kind::boolean},
    {"root", "bufferViews", Kind::list, "bufferView"},
    {"bufferView", "buffer", Kind::index, "/buffers", 0, 0, kRequired},
    {"bufferView", "byteOffset", Kind::whole, "", 0, kAnySize},
    {"bufferView", "byteLength", Kind::whole, "", 1, kAnySize, kRequired},
    {"bufferView", "byteStride", Kind::whole, "", 1, 252},
    {"bufferView", "extensions", Kind::object, "bufferViewExtensions"},
    {"bufferViewExtensions", "EXT_meshopt_compression", Kind::object, "meshoptView"},
    {"meshoptView", "buffer", Kind::index, "/buffers", 0, 0, kRequired},
    {"meshoptView", "byteOffset", Kind::whole, "", 0, kAnyInt},
    {"meshoptView", "byteLength", Kind::whole, "", 1, kAnyInt, kRequired},
    {"meshoptView", "byteStride", Kind::whole, "", 1, 256, kRequired},
    {"meshoptView", "count", Kind::whole, "", 1, kAnyInt, kRequired},
    {"meshoptView", "mode", Kind::string, "", 0, 0, kRequired},
    {"meshoptView", "filter", Kind::string},

    {"root", "accessors", Kind::list, "accessor"},
    {"accessor", "bufferView", Kind::index, "/bufferViews"},
    {"accessor", "byteOffset", Kind::whole, "", 0, kAnySize},
    {"accessor", "componentType", Kind::whole, "", 5120, 5126, kRequired},
    {"accessor", "normalized", Kind::boolean},
    {"accessor", "count", Kind::whole, "", 1, kAnySize, kRequired},
    {"accessor", "type", Kind::string, "", 0, 0, kRequired},
    {"accessor", "sparse", Kind::object, "sparse"},
    {"sparse", "count", Kind::whole, "", 1, kAnyInt, kRequired},
    {"sparse", "indices", Kind::object, "sparseIndices", 0, 0, kRequired},
    {"sparse", "values", Kind::object, "sparseValues", 0, 0, kRequired},
    {"sparseIndices", "bufferView", Kind::index, "/bufferViews", 0, 0, kRequired},
    {"sparseIndices", "byteOffset", Kind::whole, "", 0, kAnyInt},
    {"sparseIndices", "componentType", Kind::whole, "", 5121, 5125, kRequired},
    {"sparseValues", "bufferView", Kind::index, "/bufferViews", 0, 0, kRequired},
    {"sparseValues", "byteOffset", Kind::whole, "", 0, kAnyInt},

    {"root", "meshes", Kind::list, "mesh"},
    {"mesh", "name", Kind::string},
    {"mesh", "weights", Kind::numbers},
    {"mesh", "primitives", Kind::list, "primitive", 0, 0, kRequired},
    {"primitive", "attributes", Kind::attributes, "/accessors", 0, 0, kRequired},
    {"primitive", "indices", Kind::index, "/accessors"},
    {"primitive", "material", Kind::index, "/materials"},
    {"primitive", "mode", Kind::whole, "", 0, 6},
    {"primitive", "targets", Kind::attribute_sets, "/accessors"},
    {"primitive", "extensions", Kind::object, "primitiveExtensions"},
    {"primitiveExtensions", "KHR_draco_mesh_compression", Kind::object, "draco"},
    {"draco", "bufferView", Kind::index, "/bufferViews", 0, 0, kRequired},
    {"draco", "attributes", Kind::ids, "", 0, kAnyInt, kRequired},

    {"root", "nodes", Kind::list, "node"},
    {"node", "name", Kind::string},
    {"node", "children", Kind::indices, "/nodes"},
    {"node", "mesh", Kind::index, "/meshes"},
    {"node", "skin", Kind::index, "/skins"},
    {"node", "camera", Kind::index, "/cameras"},
    {"node", "matrix", Kind::numbers, "", 0, 16},
    {"node", "rotation", Kind::numbers, "", 0, 4},
    {"node", "scale", Kind::numbers, "", 0, 3},
    {"node", "translation", Kind::numbers, "", 0, 3},
    {"node", "weights", Kind::numbers},
    {"node", "extensions", Kind::object, "nodeExtensions"},
    {"nodeExtensions", "KHR_lights_punctual", Kind::object, "nodeLight"},
    {"nodeLight", "light", Kind::index, "/extensions/KHR_lights_punctual/lights", 0, 0, kRequired},
    {"nodeExtensions", "EXT_mesh_gpu_instancing", Kind::object, "instancing"},
    {"instancing", "attributes", Kind::attributes, "/accessors", 0, 0, kRequired},
    {"root", "skins", Kind::list, "skin"},
    {"skin", "joints", Kind::indices, "/nodes", 0, 0, kRequired},
    {"skin", "inverseBindMatrices", Kind::index, "/accessors"},

    {"root", "materials", Kind::list, "material"},
    {"material", "name", Kind::string},
    {"material", "pbrMetallicRoughness", Kind::object, "metallicRoughness"},
    {"material", "normalTexture", Kind::object, "textureInfo"},
    {"material", "occlusionTexture", Kind::object, "textureInfo"},
    {"material", "emissiveTexture", Kind::object, "textureInfo"},
    {"material", "emissiveFactor", Kind::numbers, "", 0, 3},
    {"material", "alphaMode", Kind::string},
    {"material", "alphaCutoff", Kind::factor, "", 0, kAnyFloat},
    {"material", "doubleSided", Kind::boolean},
    {"material", "extensions", Kind::object, "materialExtensions"},
    {"metallicRoughness", "baseColorFactor", Kind::numbers, "", 0, 4},
    {"metallicRoughness", "metallicFactor", Kind::factor, "", 0, 1},
    {"metallicRoughness", "roughnessFactor", Kind::factor, "", 0, 1},
    {"metallicRoughness", "baseColorTexture", Kind::object, "textureInfo"},
    {"metallicRoughness", "metallicRoughnessTexture", Kind::object, "textureInfo"},
    {"textureInfo", "index", Kind::index, "/textures", 0, 0, kRequired},
    {"textureInfo", "texCoord", Kind::whole, "", 0, kAnyInt},
    {"textureInfo", "scale", Kind::number, "", -kMaxFactor, kMaxFactor},
    {"textureInfo", "extensions", Kind::object, "textureInfoExtensions"},
    {"textureInfoExtensions", "KHR_texture_transform", Kind::object, "textureTransform"},
    {"textureTransform", "offset", Kind::numbers, "", kMaxTextureCoordinate, 2},
    {"textureTransform", "rotation", Kind::number, "", -kAnyFloat, kAnyFloat},
    {"textureTransform", "scale", Kind::numbers, "", kMaxTextureCoordinate, 2},
    {"textureTransform", "texCoord", Kind::whole, "", 0, kAnyInt},
    {"materialExtensions", "KHR_materials_emissive_strength", Kind::object, "emissiveStrength"},
    {"emissiveStrength", "emissiveStrength", Kind::factor, "", 0, kAnyFloat},
    {"materialExtensions", "KHR_materials_ior", Kind::object, "ior"},
    {"ior", "ior", Kind::factor, "", 0, kMaxFactor},
    {"materialExtensions", "KHR_materials_specular", Kind::object, "specular"},
    {"specular", "specularFactor", Kind::factor, "", 0, 1},
    {"specular", "specularColorFactor", Kind::numbers, "", 0, 3},
    {"specular", "specularTexture", Kind::object, "textureInfo"},
    {"specular", "specularColorTexture", Kind::object, "textureInfo"},
    {"materialExtensions", "KHR_materials_pbrSpecularGlossiness", Kind::object,
     "specularGlossiness"},
    {"specularGlossiness", "diffuseFactor", Kind::numbers, "", 0, 4},
    {"specularGlossiness", "diffuseTexture", Kind::object, "textureInfo"},
    {"specularGlossiness", "specularFactor", Kind::numbers, "", 0, 3},
    {"specularGlossiness", "glossinessFactor", Kind::factor, "", 0, 1},
    {"specularGlossiness", "specularGlossinessTexture", Kind::object, "textureInfo"},
    {"materialExtensions", "KHR_materials_clearcoat", Kind::object, "clearcoat"},
    {"clearcoat", "clearcoatFactor", Kind::factor, "", 0, 1},
    {"clearcoat", "clearcoatTexture", Kind::object, "textureInfo"},
    {"clearcoat", "clearcoatRoughnessFactor", Kind::factor, "", 0, 1},
    {"clearcoat", "clearcoatRoughnessTexture", Kind::object, "textureInfo"},
    {"clearcoat", "clearcoatNormalTexture", Kind::object, "textureInfo"},
    {"materialExtensions", "KHR_materials_sheen", Kind::object, "sheen"},
    {"sheen", "sheenColorFactor", Kind::numbers, "", 0, 3},
    {"sheen", "sheenColorTexture", Kind::object, "textureInfo"},
    {"sheen", "sheenRoughnessFactor", Kind::factor, "", 0, 1},
    {"sheen", "sheenRoughnessTexture", Kind::object, "textureInfo"},
    {"materialExtensions", "KHR_materials_iridescence", Kind::object, "iridescence"},
    {"iridescence", "iridescenceFactor", Kind::factor, "", 0, 1},
    {"iridescence", "iridescenceTexture", Kind::object, "textureInfo"},
    {"iridescence", "iridescenceIor", Kind::factor, "", 1, kMaxFactor},
    {"iridescence", "iridescenceThicknessMinimum", Kind::factor, "", 0, kMaxFactor},
    {"iridescence", "iridescenceThicknessMaximum", Kind::factor, "", 0, kMaxFactor},
    {"iridescence", "iridescenceThicknessTexture", Kind::object, "textureInfo"},
    {"materialExtensions", "KHR_materials_transmission", Kind::object, "transmission"},
    {"transmission", "transmissionFactor", Kind::factor, "", 0, 1},
    {"transmission", "transmissionTexture", Kind::object, "textureInfo"},
    {"materialExtensions", "KHR_materials_volume", Kind::object, "volume"},
    {"volume", "thicknessFactor", Kind::factor, "", 0, kAnyFloat},
    {"volume", "thicknessTexture", Kind::object, "textureInfo"},
    {"volume", "attenuationDistance", Kind::factor, "", 0, kAnyFloat},
    {"volume", "attenuationColor", Kind::numbers, "", kAnyFloat, 3},
    {"materialExtensions", "KHR_materials_unlit", Kind::object, "unlit"},

    {"root", "textures", Kind::list, "texture"},
    {"texture", "source", Kind::index, "/images"},
    {"texture", "sampler", Kind::index, "/samplers"},
    {"texture", "extensions", Kind::object, "textureExtensions"},
    {"textureExtensions", "EXT_texture_webp", Kind::object, "textureSource"},
    {"textureSource", "source", Kind::index, "/images", 0, 0, kRequired},
    {"root", "samplers", Kind::list, "sampler"},
    {"sampler", "magFilter", Kind::whole, "", 9728, 9729},
    {"sampler", "minFilter", Kind::whole, "", 9728, 9987},
    {"sampler", "wrapS", Kind::whole, "", 10497, 33648},
    {"sampler", "wrapT", Kind::whole, "", 10497, 33648},
    {"root", "images", Kind::list, "image"},
    {"image", "name", Kind::string},
    {"image", "uri", Kind::string},
    {"image", "mimeType", Kind::string},
    {"image", "bufferView", Kind::index, "/bufferViews"},

    {"root", "cameras", Kind::list, "camera"},
    {"camera", "name", Kind::string},
    {"camera", "type", Kind::string, "", 0, 0, kRequired},
    {"camera", "perspective", Kind::object, "perspective"},
    {"camera", "orthographic", Kind::object, "orthographic"},
    {"perspective", "yfov", Kind::number, "", kSmallestFov, kLargestFov, kRequired},
    {"perspective", "aspectRatio", Kind::number, "", kTiny, kAnyFloat},
    {"perspective", "znear", Kind::number, "", 0, kAnyFloat, kRequired},
    {"orthographic", "xmag", Kind::number, "", -kAnyFloat, kAnyFloat, kRequired},
    {"orthographic", "ymag", Kind::number, "", -kAnyFloat, kAnyFloat, kRequired},
    {"orthographic", "znear", Kind::number, "", 0, kAnyFloat, kRequired},
    {"orthographic", "zfar", Kind::number, "", 0, kAnyFloat, kRequired},

    {"root", "extensions", Kind::object, "rootExtensions"},
    {"rootExtensions", "KHR_lights_punctual", Kind::object, "lights"},
    {"lights", "lights", Kind::list, "light", 0, 0, kRequired},
    {"light", "name", Kind::string},
    {"light", "type", Kind::string, "", 0, 0, kRequired},
    {"light", "color", Kind::numbers, "", 0, 3},
    {"light", "intensity", Kind::factor, "", 0, kAnyFloat},
    {"light", "range", Kind::reach},
    {"light", "spot", Kind::object, "spot"},
    {"spot", "innerConeAngle", Kind::factor, "", 0, kQuarterTurn},
    {"spot", "outerConeAngle", Kind::factor, "", kTiny, kQuarterTurn},
};

}  // namespace lambent::gltf
