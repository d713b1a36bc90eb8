// SPDX-License-Identifier: Apache-2.0
// Memory for large arrays that are read all over.
//
// Where a program jumps about in more memory than the processor keeps page addresses of, it waits
// for these more than for what it reads. Large pages need 512 times fewer.
#pragma once

#include <cstddef>
#include <vector>

namespace lambent {

/// `bytes` of memory, aligned to lines of the cache or more; where there are many, in large pages
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

/// Floats that start at a line of the cache, for kernels whose loads should not straddle two.
using AlignedFloats = std::vector<float, LargePages<float>>;

}  // namespace lambent
