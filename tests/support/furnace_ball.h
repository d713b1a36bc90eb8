// SPDX-License-Identifier: Apache-2.0
// A ball in light of radiance 1 from all around.
#pragma once

#include <cmath>
#include <vector>

#include "compose/pixel_math.h"
#include "lambent/renderer.h"
#include "lambent/scene.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "shared/constants.h"
#include "support/field_scenes.h"

namespace lambent::test {

/// A ball of the material within black walls that shine, or under a sky: nothing else reflects.
inline Scene furnace_ball(const Material& material, bool sky) {
  Scene scene;
  scenes::MeshBuilder builder;
  if (sky) {
    scene.environment.radiance = glm::vec3(1.0f);
  } else {
    const int wall = scenes::add_lambert(scene, "wall", glm::vec3(0.0f), glm::vec3(1.0f));
    builder.room(glm::vec3(-3.0f), glm::vec3(3.0f));
    scenes::add_object(scene, builder.take("room", wall));
  }
  scene.materials.push_back(material);
  std::vector<glm::vec2> profile;
  constexpr int kSteps = 192;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = kPi * static_cast<float>(i) / kSteps;
    const bool pole = i == 0 || i == kSteps;
    profile.emplace_back(pole ? 0.0f : std::sin(angle), -std::cos(angle));
  }
  builder.lathe(glm::vec3(0.0f), profile, 2 * kSteps);
  scenes::add_object(scene, builder.take("ball", static_cast<int>(scene.materials.size()) - 1));
  scenes::add_camera(scene, "ball", {0.0f, 0.4f, 2.9f}, glm::vec3(0.0f), 0.9f, 1.0f);
  return scene;
}

/// Mean over a square picture of what `reflected(surface, to_viewer_ws, point)` says of the points
/// of the ball that its samples see, in order, by the frame's default seed.
template <class Reflected>
double mean_over_ball(const Stage& stage, int side, int samples, Reflected reflected) {
  double sum = 0.0;
  uint point = 0;
  for (int k = 0; k < samples; ++k) {
    const vec2 place =
        subpixel_position(static_cast<uint>(k), static_cast<uint>(samples), FrameSettings{}.seed);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const Ray ray =
            camera_ray(stage.scene.cameras[0], side, side, static_cast<float>(x) + place.x,
                       static_cast<float>(y) + place.y);
        const Hit hit = tracer_of(stage.world).closest_hit(ray);
        ++point;
        if (hit.missed()) continue;
        const Surface surface = surface_at(stage.scene, ray, hit);
        if (has_no_base(surface.reflectance) && has_no_coat(surface.reflectance)) continue;
        sum += reflected(surface, -ray.direction, point);
      }
    }
  }
  return sum / (static_cast<double>(side) * side * samples);
}

}  // namespace lambent::test
