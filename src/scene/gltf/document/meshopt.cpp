// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, EXT_meshopt_compression.
#include "scene/gltf/document/meshopt.h"

#include <meshoptimizer.h>

namespace lambent::gltf {
namespace {

// The vertex codec, the densest of the three, spends at least 2 bits on 16 bytes: 64 times smaller.
// Streams that would have to be more than twice as dense are refused before anything is allocated.
constexpr std::size_t kMaxExpansion = 128;

struct Stream {
  ByteSpan bytes;
  std::size_t count = 0;
  std::size_t stride = 0;
  std::string mode;
  std::string filter;
};

const char* shape_flaw(const Stream& s) {
  if (s.mode == "ATTRIBUTES") {
    if (s.stride % 4 != 0 || s.stride > 256)
      return "ATTRIBUTES need a stride that is a multiple of 4";
  } else if (s.mode == "TRIANGLES" || s.mode == "INDICES") {
    if (s.stride != 2 && s.stride != 4) return "indices need a stride of 2 or 4";
    if (s.mode == "TRIANGLES" && s.count % 3 != 0) return "TRIANGLES need three indices each";
    if (s.filter != "NONE") return "indices cannot be filtered";
  } else {
    return "the compression mode is not known";
  }
  if (s.filter == "OCTAHEDRAL" && s.stride != 4 && s.stride != 8) {
    return "OCTAHEDRAL needs a stride of 4 or 8";
  }
  if (s.filter == "QUATERNION" && s.stride != 8) return "QUATERNION needs a stride of 8";
  if (s.filter != "NONE" && s.filter != "OCTAHEDRAL" && s.filter != "QUATERNION" &&
      s.filter != "EXPONENTIAL") {
    return "the filter is not known";
  }
  return nullptr;
}

bool decode(const Stream& s, Bytes& out) {
  const std::uint8_t* in = s.bytes.data();
  const std::size_t size = s.bytes.size();
  int status = 0;
  if (s.mode == "ATTRIBUTES") {
    status = meshopt_decodeVertexBuffer(out.data(), s.count, s.stride, in, size);
  } else if (s.mode == "TRIANGLES") {
    status = meshopt_decodeIndexBuffer(out.data(), s.count, s.stride, in, size);
  } else {
    status = meshopt_decodeIndexSequence(out.data(), s.count, s.stride, in, size);
  }
  if (status != 0) return false;
  if (s.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), s.count, s.stride);
  if (s.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), s.count, s.stride);
  if (s.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), s.count, s.stride);
  return true;
}

Expected<Bytes> decompress(const Document& document, const tinygltf::Value& extension, int view) {
  const std::string place = entry("bufferViews", view) + ".extensions.EXT_meshopt_compression";
  const int buffer_index = integer_or(extension, "buffer", 0);
  const Bytes& buffer = document.buffers[buffer_index];
  const auto offset = static_cast<std::size_t>(integer_or(extension, "byteOffset", 0));
  const auto length = static_cast<std::size_t>(integer_or(extension, "byteLength", 0));
  if (offset > buffer.size() || length > buffer.size() - offset) {
    return document.fail_at(place, "extends beyond the end of " + entry("buffers", buffer_index));
  }

  Stream stream;
  stream.bytes = ByteSpan(buffer).subspan(offset, length);
  stream.count = static_cast<std::size_t>(integer_or(extension, "count", 0));
  stream.stride = static_cast<std::size_t>(integer_or(extension, "byteStride", 0));
  stream.mode = extension.Get("mode").Get<std::string>();
  stream.filter = extension.Has("filter") ? extension.Get("filter").Get<std::string>() : "NONE";
  if (const char* flaw = shape_flaw(stream)) return document.fail_at(place, flaw);
  if (stream.count * stream.stride > length * kMaxExpansion) {
    return document.fail_at(place, "the stream is too short for what it should hold");
  }
  if (document.model.bufferViews[view].byteLength != stream.count * stream.stride) {
    return document.fail_at(place, "count times byteStride is not the buffer view's byteLength");
  }
  Bytes out(stream.count * stream.stride);
  if (!decode(stream, out)) return document.fail_at(place, "the compressed stream is corrupt");
  return out;
}

}  // namespace

Expected<void> decompress_views(Document& document) {
  const auto& views = document.model.bufferViews;
  document.decompressed_views.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto* extension = find_extension(views[i].extensions, "EXT_meshopt_compression");
    if (!extension) continue;
    LAMBENT_TRY(bytes, decompress(document, *extension, static_cast<int>(i)));
    document.decompressed_views[i] = std::move(bytes);
  }
  return {};
}

}  // namespace lambent::gltf
