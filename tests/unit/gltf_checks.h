// SPDX-License-Identifier: Apache-2.0
// What tests of the glTF importer share beside the files that they make.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <stdexcept>
#include <utility>

#include "unit/gltf_builder.h"

namespace lambent::test {

/// Sine and cosine of 45 degrees: half of a turn by 90 degrees, as quaternions have it.
inline const float kHalf = std::sqrt(0.5f);

inline void expect_near(const glm::vec3& actual, const glm::vec3& expected) {
  EXPECT_LT(glm::length(actual - expected), 1e-5f)
      << actual.x << " " << actual.y << " " << actual.z;
}

/// The scene of a file that must be good.
inline Scene loaded(const GltfBuilder& builder) {
  Expected<Scene> scene = builder.load();
  if (!scene) throw std::runtime_error(error_of(scene));
  return std::move(*scene);
}

}  // namespace lambent::test
