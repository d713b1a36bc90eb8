// SPDX-License-Identifier: Apache-2.0
// Common parts of benches and measurements: scenes with light and a camera.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent::bench {

/// The value of a result. Throws std::runtime_error if it is an error.
template <class Value>
Value value_or_throw(Expected<Value> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}
inline void value_or_throw(const Expected<void>& result) {
  if (!result) throw std::runtime_error(result.error().message());
}

/// Opens a built-in scene or a file. If it has no light, adds a sun and a sky; if it has no camera,
/// adds one that looks along its length from near one end.
Scene open_stage(const std::string& name);

}  // namespace lambent::bench
