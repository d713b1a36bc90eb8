// SPDX-License-Identifier: Apache-2.0
// Boxes in the extras of nodes: probe volumes and fog.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "lambent/scene.h"

namespace lambent::gltf {

/// Reads a number within bounds; returns false if there is none.
inline bool read_number(const nlohmann::json& value, double low, double high, double& number) {
  if (!value.is_number()) return false;
  number = value.get<double>();
  return number >= low && number <= high;
}

/// Reads three numbers within bounds, which must be whole for vectors of integers; returns false if
/// there are none.
template <class Vector>
bool read_vector(const nlohmann::json& value, double low, double high, Vector& vector) {
  if (!value.is_array() || value.size() != 3) return false;
  for (int axis = 0; axis < 3; ++axis) {
    double number = 0.0;
    if (!read_number(value[axis], low, high, number)) return false;
    constexpr bool kWhole = std::is_integral_v<typename Vector::value_type>;
    if (kWhole && number != std::floor(number)) return false;
    vector[axis] = static_cast<typename Vector::value_type>(number);
  }
  return true;
}

/// Places a box of a size by the transform of its node. Returns null, or the reason why that is not
/// possible.
const char* place_box(const glm::mat4& world_from_node, glm::vec3& centre, glm::vec3& size,
                      glm::mat3& axes);

}  // namespace lambent::gltf
