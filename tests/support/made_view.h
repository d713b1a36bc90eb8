// SPDX-License-Identifier: Apache-2.0
// Views of reflective shadow maps that tests make pixel by pixel.
#pragma once

#include <vector>

#include "lambent/rsm.h"

namespace lambent::test {

/// What a picture sees; rows from the top.
struct MadeView {
  MadeView(int w, int h) : width(w), height(h) {}

  void add(const glm::vec3& position, const glm::vec3& normal, float depth) {
    positions.push_back(position);
    normals.push_back(normal);
    depths.push_back(depth);
  }
  RsmView view() const { return {width, height, positions, normals, depths}; }

  int width, height;
  std::vector<glm::vec3> positions, normals;
  std::vector<float> depths;
};

}  // namespace lambent::test
