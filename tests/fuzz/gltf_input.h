// SPDX-License-Identifier: Apache-2.0
// How a file of the glTF corpus becomes a file for the importer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lambent::test {

/// The bytes themselves; or, for JSON text, a zero byte and a binary chunk, the GLB of both. A
/// fuzzer that had to keep a GLB's lengths right would seldom get beyond them.
inline std::vector<std::uint8_t> gltf_from_fuzz_input(std::span<const std::uint8_t> input) {
  const auto zero = std::find(input.begin(), input.end(), std::uint8_t{0});
  if (input.empty() || input[0] != '{' || zero == input.end()) return {input.begin(), input.end()};
  const std::span<const std::uint8_t> json(input.begin(), zero);
  const std::span<const std::uint8_t> binary(zero + 1, input.end());

  std::vector<std::uint8_t> glb = {'g', 'l', 'T', 'F', 2, 0, 0, 0};
  const auto put = [&glb](std::size_t value) {
    for (int i = 0; i < 4; ++i) glb.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  };
  constexpr std::size_t kHeaders = 12 + 2 * 8;
  constexpr std::size_t kJsonChunk = 0x4E4F534A;
  constexpr std::size_t kBinaryChunk = 0x004E4942;
  put(kHeaders + json.size() + binary.size());
  put(json.size());
  put(kJsonChunk);
  glb.insert(glb.end(), json.begin(), json.end());
  put(binary.size());
  put(kBinaryChunk);
  glb.insert(glb.end(), binary.begin(), binary.end());
  return glb;
}

}  // namespace lambent::test
