// SPDX-License-Identifier: Apache-2.0
// Fields over built-in scenes, as the tests of the field want them.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
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
  return visible_points(stage.world, stage.scene.cameras[0], 48, 27).value();
}

/// Settings that leave storage out of what is tested.
inline FieldSettings exact_formats() {
  FieldSettings settings;
  settings.irradiance_format = IrradianceFormat::float32;
  settings.distance_format = DistanceFormat::rg32f;
  return settings;
}

}  // namespace lambent::test
