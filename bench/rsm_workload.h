// SPDX-License-Identifier: Apache-2.0
// The workload of benches of reflective shadow maps.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lambent/rsm.h"

namespace lambent::bench {

/// The view of the camera of workload(), and the maps of all lights.
struct RsmWorkload {
  explicit RsmWorkload(const glm::ivec2& picture);
  RsmView view() const { return {size.x, size.y, positions, normals, depths}; }

  glm::ivec2 size;
  std::vector<glm::vec3> positions, normals;
  std::vector<float> depths;
  std::vector<ReflectiveShadowMap> maps;
};

/// Settings that are the default but for the layout.
inline RsmSettings with_layout(RsmLayout layout) {
  RsmSettings settings;
  settings.layout = layout;
  return settings;
}

/// The workload with 1920 x 1080 pixels, or the size in LAMBENT_BENCH_RSM_SIZE=WxH.
RsmWorkload& rsm_workload();

}  // namespace lambent::bench
