// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace lambent {

/// Calls body(begin, end) for consecutive ranges of at most `chunk` that cover [0, count), on all
/// cores. The ranges depend on `count` and `chunk` alone, never on the number of threads.
void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Like parallel_chunks, for bodies that return a number. Adds the numbers in the order of the
/// ranges, so that the sum has the same bits on any number of threads.
double parallel_sum(std::size_t count, std::size_t chunk,
                    const std::function<double(std::size_t begin, std::size_t end)>& body);

}  // namespace lambent
