// SPDX-License-Identifier: Apache-2.0
// A field in a world that is edited, and measures of its light.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "field/field_access.h"
#include "field/probes/probe_store.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "shared/color.h"

namespace lambent::test {

/// A scene that may be edited, its world, and a field over it that has averaged a few updates.
struct Edited {
  explicit Edited(const std::string& name, const FieldSettings& settings = few(), int updates = 6)
      : Edited(scenes::make(name).value(), settings, updates) {}
  Edited(Scene made, const FieldSettings& settings, int updates)
      : scene(std::move(made)),
        world(scene),
        field(IrradianceField::make(settings, open_bounds(world)).value()) {
    for (int i = 0; i < updates; ++i) field.update(world);
  }

  static FieldSettings few() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(5);
    settings.rays_per_probe = 128;
    settings.irradiance_format = IrradianceFormat::float32;
    return settings;
  }

  /// Updates the field until open air has followed, too, without a probe traced anew after the
  /// first. What that first update did, but touched by all of them.
  UpdateStatistics follow() {
    EXPECT_TRUE(world.update().has_value());
    UpdateStatistics first = field.update(world);
    // With a budget of one ray one probe in open air follows in each update; there are 27
    constexpr int kUpdatesOfOpenAir = 28;
    for (int i = 1; i < kUpdatesOfOpenAir; ++i) {
      const UpdateStatistics later = field.update(world, {.ray_budget = 1});
      EXPECT_EQ(later.probes_traced, 0);
      first.probes_changed += later.probes_changed;
    }
    return first;
  }

  /// What a field over the scene as it is now settles to.
  IrradianceField settled() const {
    const World now(scene);
    IrradianceField fresh = IrradianceField::make(field.settings(), open_bounds(now)).value();
    for (int i = 0; i < 24; ++i) fresh.update(now);
    return fresh;
  }

  Scene scene;
  World world;
  IrradianceField field;
};

/// Luminance at points all over the field, facing six ways.
inline std::vector<double> light_of(const IrradianceField& field) {
  const FieldGrid& grid = field.grids()[0];
  std::vector<FieldQuery> queries;
  constexpr int kPoints = 4;
  for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
    const glm::vec3 place(i % kPoints, i / kPoints % kPoints, i / (kPoints * kPoints));
    const glm::vec3 share = (place + 0.5f) / static_cast<float>(kPoints);
    for (int axis = 0; axis < 6; ++axis) {
      glm::vec3 normal(0.0f);
      normal[axis / 2] = axis % 2 == 0 ? 1.0f : -1.0f;
      queries.push_back(
          {grid.origin + share * grid.spacing * glm::vec3(grid.count - 1), normal, normal});
    }
  }
  std::vector<glm::vec3> irradiance(queries.size());
  field.irradiance(queries, irradiance);
  std::vector<double> light;
  for (const glm::vec3& e : irradiance) light.push_back(luminance(e));
  return light;
}

inline double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

inline double relative_rmse(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size())) / mean(b);
}

inline std::vector<uint> words_of(const IrradianceField& field) {
  const auto words = store_of(field).irradiance_words();
  return {words.begin(), words.end()};
}

}  // namespace lambent::test
