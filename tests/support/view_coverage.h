// SPDX-License-Identifier: Apache-2.0
// What a camera's picture shows, by a grid of rays.
#pragma once

#include <algorithm>
#include <vector>

#include "lambent/world.h"
#include "raytracing/camera_rays.h"
#include "raytracing/world_access.h"

namespace lambent::test {

struct Coverage {
  float met = 0.0f;           ///< Share of the pixels that show a surface.
  float backs = 0.0f;         ///< Of these, how many show its back.
  float median_depth = 0.0f;  ///< Distance that half of the pixels see [m]; infinite: sky.
  float extent = 0.0f;        ///< Share of the frame's width or height that surfaces span.
  bool cut = false;           ///< A surface reaches the frame's edge.
};

inline Coverage coverage_of(const World& world, const Camera& camera, int width = 96,
                            int height = 54) {
  Coverage coverage;
  std::vector<float> depths;
  float met = 0.0f, backs = 0.0f;
  int left = width, right = -1, top = height, bottom = -1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = camera_ray(camera, width, height, static_cast<float>(x) + 0.5f,
                                 static_cast<float>(y) + 0.5f);
      const Hit hit = tracer_of(world).closest_hit(ray);
      depths.push_back(hit.distance);
      if (hit.missed()) continue;
      met += 1.0f;
      if (!hit.front_face) backs += 1.0f;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
      if (x == 0 || y == 0 || x == width - 1 || y == height - 1) coverage.cut = true;
    }
  }
  coverage.met = met / static_cast<float>(depths.size());
  coverage.backs = met > 0.0f ? backs / met : 0.0f;
  coverage.extent = std::max(static_cast<float>(right - left + 1) / static_cast<float>(width),
                             static_cast<float>(bottom - top + 1) / static_cast<float>(height));
  std::nth_element(depths.begin(), depths.begin() + depths.size() / 2, depths.end());
  coverage.median_depth = depths[depths.size() / 2];
  return coverage;
}

}  // namespace lambent::test
