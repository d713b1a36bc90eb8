// SPDX-License-Identifier: Apache-2.0
// Fields over built-in scenes, as the tests of the field want them.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lambent/field.h"
#include "lambent/world.h"
#include "raytracing/camera_rays.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "scenes/builtin.h"

namespace lambent::test {

/// A built-in scene made ready for light.
struct Stage {
  explicit Stage(Scene made) : scene(std::move(made)), world(scene) {}
  explicit Stage(const std::string& name) : Stage(scenes::make(name).value()) {}
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  Bounds bounds() const { return open_bounds(world); }

  const Scene scene;
  const World world;
};

/// A field over the stage after so many updates.
inline IrradianceField make_field(const Stage& stage, const FieldSettings& settings,
                                  int updates = 1) {
  Expected<IrradianceField> field = IrradianceField::make(settings, stage.bounds());
  if (!field) throw std::runtime_error(field.error().message());
  for (int i = 0; i < updates; ++i) field->update(stage.world);
  return std::move(*field);
}

inline std::vector<glm::vec3> look_up(const IrradianceField& field,
                                      std::span<const FieldQuery> queries) {
  std::vector<glm::vec3> result(queries.size());
  field.irradiance(queries, result);
  return result;
}

/// What the scene's first camera sees, one point a pixel of a small picture.
inline std::vector<FieldQuery> seen_points(const Stage& stage) {
  constexpr int kWidth = 48, kHeight = 27;
  std::vector<FieldQuery> queries;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const Ray ray =
        camera_ray(stage.scene.cameras[0], kWidth, kHeight, static_cast<float>(i % kWidth) + 0.5f,
                   static_cast<float>(i / kWidth) + 0.5f);
    const Hit hit = stage.world.tracer().closest_hit(ray);
    if (hit.missed()) continue;
    const Surface surface = surface_at(stage.scene, ray, hit);
    queries.push_back({surface.position_ws, surface.normal_ws, -ray.direction});
  }
  return queries;
}

/// Settings that leave storage out of what is tested.
inline FieldSettings exact_formats() {
  FieldSettings settings;
  settings.irradiance_format = IrradianceFormat::float32;
  settings.distance_format = DistanceFormat::rg32f;
  return settings;
}

}  // namespace lambent::test
