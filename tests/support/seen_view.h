// SPDX-License-Identifier: Apache-2.0
// What a camera sees of a scene, as reflective shadow maps are asked.
#pragma once

#include "lambent/world.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "support/made_view.h"

namespace lambent::test {

/// Through the middle of each pixel.
inline MadeView seen_view(const World& world, const Camera& camera, int width, int height) {
  MadeView view(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = camera_ray(camera, width, height, static_cast<float>(x) + 0.5f,
                                 static_cast<float>(y) + 0.5f);
      const Hit hit = tracer_of(world).closest_hit(ray);
      if (hit.missed()) {
        view.add(glm::vec3(0.0f), glm::vec3(0.0f), 0.0f);
        continue;
      }
      const Surface surface = surface_at(world.scene(), ray, hit);
      view.add(surface.position_ws, surface.normal_ws, view_depth(camera, surface.position_ws));
    }
  }
  return view;
}

}  // namespace lambent::test
