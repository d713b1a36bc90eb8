// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, section 4.4, "GLB File Format Specification".
#include "scenes/glb_container.h"

#include <cstdint>

namespace lambent::scenes {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeader = 12, kChunkHeader = 8;  // [bytes]
constexpr std::size_t kAlignment = 4;                  // of chunks and views [bytes]

std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

}  // namespace

int GlbContainer::add_view(const void* data, std::size_t bytes, int target) {
  const std::size_t offset = binary_.size();
  binary_.append(static_cast<const char*>(data), bytes);
  binary_.resize(aligned(binary_.size()), '\0');
  nlohmann::json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
  if (target != 0) view["target"] = target;
  root["bufferViews"].push_back(std::move(view));
  return static_cast<int>(root["bufferViews"].size()) - 1;
}

int GlbContainer::add_accessor(nlohmann::json accessor, const void* data, std::size_t bytes,
                               int target) {
  accessor["bufferView"] = add_view(data, bytes, target);
  root["accessors"].push_back(std::move(accessor));
  return static_cast<int>(root["accessors"].size()) - 1;
}

std::string GlbContainer::assemble() {
  root["buffers"] = {{{"byteLength", binary_.size()}}};
  std::string text = root.dump();
  text.resize(aligned(text.size()), ' ');
  std::string out;
  const auto put = [&out](std::size_t word) {
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(word >> shift));
  };
  put(kMagic);
  put(kVersion);
  put(kHeader + 2 * kChunkHeader + text.size() + binary_.size());
  put(text.size());
  put(kJsonChunk);
  out += text;
  put(binary_.size());
  put(kBinaryChunk);
  out += binary_;
  return out;
}

}  // namespace lambent::scenes
