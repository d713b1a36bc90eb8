// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, KHR_draco_mesh_compression.
#include "scene/gltf/document/draco.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <memory>

namespace lambent::gltf {
namespace {

// Largest value of an integer type, by which normalised values are divided.
float largest_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 127.0f;
    case draco::DT_UINT8:
      return 255.0f;
    case draco::DT_INT16:
      return 32767.0f;
    case draco::DT_UINT16:
      return 65535.0f;
    case draco::DT_INT32:
      return 2147483647.0f;
    case draco::DT_UINT32:
      return 4294967295.0f;
    default:
      return 1.0f;
  }
}

template <class T>
bool convert(const draco::PointAttribute& source, std::uint32_t points, bool normalized,
             Elements& elements) {
  const float divisor = normalized ? largest_of(source.data_type()) : 1.0f;
  T values[4] = {};
  for (std::uint32_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex value = source.mapped_index(draco::PointIndex(i));
    if (value.value() >= source.size()) return false;
    if (!source.ConvertValue<T>(value, static_cast<std::int8_t>(elements.components), values)) {
      return false;
    }
    for (int k = 0; k < elements.components; ++k) {
      const float number = static_cast<float>(values[k]) / divisor;
      elements.values.push_back(normalized ? std::max(number, -1.0f) : number);
    }
  }
  return true;
}

Expected<Elements> read_attribute(const Document& document, const draco::Mesh& mesh, int id,
                                  bool normalized, const std::string& place) {
  const draco::PointAttribute* source = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (!source) return document.fail_at(place, "the stream has no attribute " + std::to_string(id));
  Elements elements;
  elements.components = source->num_components();
  constexpr int kMaxComponents = 4;
  if (elements.components < 1 || elements.components > kMaxComponents) {
    return document.fail_at(place, "the attribute has an impossible number of components");
  }
  elements.values.reserve(static_cast<std::size_t>(mesh.num_points()) * elements.components);
  const bool is_float = source->data_type() == draco::DT_FLOAT32;
  const bool converted =
      is_float ? convert<float>(*source, mesh.num_points(), false, elements)
               : convert<std::int64_t>(*source, mesh.num_points(), normalized, elements);
  if (!converted) return document.fail_at(place, "the attribute cannot be decoded");
  return elements;
}

}  // namespace

Expected<DracoPrimitive> decode_draco(const Document& document,
                                      const tinygltf::Primitive& primitive,
                                      const tinygltf::Value& extension, const std::string& place) {
  const int view = integer_or(extension, "bufferView", 0);
  LAMBENT_TRY(bytes, view_bytes(document, view));
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) {
    return document.fail_at(place + " (" + entry("bufferViews", view) + ")",
                            "the Draco stream is corrupt: " + decoded.status().error_msg_string());
  }
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

  DracoPrimitive result;
  result.indices.reserve(static_cast<std::size_t>(mesh->num_faces()) * 3);
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) result.indices.push_back(mesh->face(f)[k].value());
  }
  const tinygltf::Value& ids = extension.Get("attributes");
  for (const std::string& name : ids.Keys()) {
    const auto accessor = primitive.attributes.find(name);
    const bool normalized = accessor != primitive.attributes.end() &&
                            document.model.accessors[accessor->second].normalized;
    LAMBENT_TRY(elements, read_attribute(document, *mesh, ids.Get(name).GetNumberAsInt(),
                                         normalized, place + "." + name));
    result.attributes[name] = std::move(elements);
  }
  return result;
}

}  // namespace lambent::gltf
