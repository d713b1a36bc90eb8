// SPDX-License-Identifier: Apache-2.0
#include "core/large_pages.h"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace lambent {
namespace {

constexpr std::size_t kLineBytes = 64;                    // a cache line
constexpr std::size_t kPageBytes = std::size_t{2} << 20;  // a large page of x86-64 and of AArch64
// Least size for large pages: the last page of an array is half empty on average.
constexpr std::size_t kManyBytes = 2 * kPageBytes;

std::size_t rounded_up(std::size_t bytes, std::size_t to) {
  return (bytes + to - 1) / to * to;
}

}  // namespace

void* allocate_pages(std::size_t bytes) {
  const bool many = bytes >= kManyBytes;
  const std::size_t unit = many ? kPageBytes : kLineBytes;
  const std::size_t whole = rounded_up(bytes, unit);
  void* memory = whole >= bytes ? std::aligned_alloc(unit, whole) : nullptr;
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  // If the system has none, this fails and small pages are used
  if (many) madvise(memory, whole, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_pages(void* memory) noexcept {
  std::free(memory);
}

}  // namespace lambent
