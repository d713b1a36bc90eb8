// SPDX-License-Identifier: Apache-2.0
// What a shader says of itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vulkan/kernel.h"

namespace lambent::vulkan {

/// A descriptor that a shader reads.
struct ReflectedBinding {
  std::uint32_t set = 0, binding = 0;
};

struct Reflection {
  std::array<std::uint32_t, 3> group_size = {1, 1, 1};  ///< Of a compute shader.
  std::uint32_t argument_bytes = 0;                     ///< Of its push constants.
  /// Byte offset of each member of the struct of arguments: the first member of the block, where
  /// that is one.
  std::vector<std::uint32_t> argument_offsets;
  std::vector<ReflectedBinding> bindings;
};

/// Reads a module. Throws std::runtime_error where it is not SPIR-V.
Reflection reflect(Spirv spirv);

}  // namespace lambent::vulkan
