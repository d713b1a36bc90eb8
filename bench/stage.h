// SPDX-License-Identifier: Apache-2.0
// What benches and measurements share: scenes that have light and a camera.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent::bench {

/// What must be there for a bench to go on. Throws std::runtime_error where it is not.
template <class Value>
Value value_or_throw(Expected<Value> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}
inline void value_or_throw(const Expected<void>& result) {
  if (!result) throw std::runtime_error(result.error().message());
}

/// A built-in scene or a file; where that brings no light, under a sun and a sky, and where it
/// brings no camera, with one that looks along its length from near one end.
Scene open_stage(const std::string& name);

}  // namespace lambent::bench
