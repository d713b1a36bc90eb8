// SPDX-License-Identifier: Apache-2.0
// Reflection of a shader's interface from its SPIR-V.
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
  std::array<std::uint32_t, 3> group_size = {1, 1, 1};  ///< Workgroup size of a compute shader.
  std::uint32_t argument_bytes = 0;                     ///< Size of its push constants.
  /// Byte offset of each member of the struct of arguments, which is the first member of the block
  /// if that is a struct.
  std::vector<std::uint32_t> argument_offsets;
  std::vector<ReflectedBinding> bindings;
};

/// Reads a module. Throws std::runtime_error where it is not SPIR-V.
Reflection reflect(Spirv spirv);

}  // namespace lambent::vulkan
