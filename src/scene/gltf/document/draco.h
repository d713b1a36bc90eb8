// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "scene/gltf/document/accessors.h"

namespace lambent::gltf {

/// The contents of a primitive's compressed stream.
struct DracoPrimitive {
  std::vector<std::uint32_t> indices;  ///< Three per triangle.
  std::map<std::string, Elements> attributes;
};

/// Decodes KHR_draco_mesh_compression. `place` names the primitive in errors.
Expected<DracoPrimitive> decode_draco(const Document& document,
                                      const tinygltf::Primitive& primitive,
                                      const tinygltf::Value& extension, const std::string& place);

}  // namespace lambent::gltf
