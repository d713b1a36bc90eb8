// SPDX-License-Identifier: Apache-2.0
// Parallel coding of independent parts.
#pragma once

#include <cstddef>

#ifndef __EMSCRIPTEN__
#include "core/parallel.h"
#endif

namespace lambent::stream {

/// Calls body(i) for each i below `count`; on all cores, where threads are available.
template <class Body>
void on_all_cores(std::size_t count, const Body& body) {
#ifdef __EMSCRIPTEN__
  for (std::size_t i = 0; i < count; ++i) body(i);
#else
  parallel_chunks(count, 1, [&](std::size_t begin, std::size_t) { body(begin); });
#endif
}

}  // namespace lambent::stream
