// SPDX-License-Identifier: Apache-2.0
// Memory for large arrays with random access.
//
// Random access to more memory than the TLB covers spends more time on address translation than on
// the data. Large pages need 512 times fewer TLB entries.
#pragma once

#include <cstddef>
#include <vector>

namespace lambent {

/// Allocates `bytes` of memory, aligned to at least a cache line; large allocations use large pages
/// if the system has them. Throws std::bad_alloc where there is no memory.
void* allocate_pages(std::size_t bytes);
void free_pages(void* memory) noexcept;

/// For standard containers.
template <class T>
struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept {}

  T* allocate(std::size_t count) { return static_cast<T*>(allocate_pages(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) noexcept { free_pages(memory); }

  template <class U>
  bool operator==(const LargePages<U>&) const noexcept {
    return true;
  }
};

/// Floats that start at a cache line, for kernels whose loads should not cross one.
using AlignedFloats = std::vector<float, LargePages<float>>;

}  // namespace lambent
