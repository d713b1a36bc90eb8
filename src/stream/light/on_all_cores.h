// SPDX-License-Identifier: Apache-2.0
// What is coded in parts that need nothing of each other.
#pragma once

#include <cstddef>

#ifndef __EMSCRIPTEN__
#include "core/parallel.h"
#endif

namespace lambent::stream {

/// Calls body(i) for each of so many; on all cores, where there are threads.
template <class Body>
void on_all_cores(std::size_t count, const Body& body) {
#ifdef __EMSCRIPTEN__
  for (std::size_t i = 0; i < count; ++i) body(i);
#else
  parallel_chunks(count, 1, [&](std::size_t begin, std::size_t) { body(begin); });
#endif
}

}  // namespace lambent::stream
