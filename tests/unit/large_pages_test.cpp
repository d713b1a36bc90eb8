// SPDX-License-Identifier: Apache-2.0
#include "core/large_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <new>
#include <vector>

namespace lambent::large_pages_test {
namespace {

TEST(LargePages, HoldArraysOfAnySize) {
  for (const std::size_t count : {1u, 100u, 3u << 20}) {
    std::vector<std::uint32_t, LargePages<std::uint32_t>> numbers(count);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(numbers.data()) % 64, 0u);
    for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(i);
    numbers.push_back(7);
    EXPECT_EQ(numbers[count - 1], count - 1);
    EXPECT_EQ(numbers[count], 7u);
  }
}

TEST(LargePages, SayWhereThereIsNoMemory) {
  EXPECT_THROW(allocate_pages(std::numeric_limits<std::size_t>::max()), std::bad_alloc);
}

}  // namespace
}  // namespace lambent::large_pages_test
