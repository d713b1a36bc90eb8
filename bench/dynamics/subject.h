// SPDX-License-Identifier: Apache-2.0
// Common parts of the measurements of a field in motion: a scene that is edited, points that a
// camera sees, and the difference of two fields.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lambent/field.h"
#include "lambent/scene.h"
#include "lambent/world.h"

namespace lambent::dynamics {

/// A scene that may be edited, and a field over it.
struct Subject {
  /// Opens a built-in scene or a file, with a sun and a sky if it has no light.
  Subject(const std::string& name, const FieldSettings& settings);

  /// A field of the same grid without light.
  IrradianceField fresh_field(const FieldSettings& settings) const;
  /// A settled field of the same grid for the current scene: many updates with many rays.
  IrradianceField settled_field() const;
  /// Updates the world after edits.
  void apply_edits();
  /// Moves the instance of that name or, if there is none, the last.
  void move(const std::string& instance, const glm::vec3& by);

  Scene scene;
  Bounds bounds;  ///< Open bounds before any edit.
  World world;
  IrradianceField field;
};

/// Points that the scene's first camera sees, one per pixel of a small picture.
std::vector<FieldQuery> seen_points(const Subject& subject, int pixels_across);

/// Luminance of the field's irradiance at points.
std::vector<double> light_at(const IrradianceField& field, std::span<const FieldQuery> points);
/// Luminance of the path tracer's irradiance, with `samples` samples per point.
std::vector<double> reference_light_at(const World& world, std::span<const FieldQuery> points,
                                       int samples);

struct Difference {
  double mean_ratio = 0.0;     ///< Ratio of a's mean to b's.
  double relative_rmse = 0.0;  ///< Root mean square of a - b over b's mean.
};
Difference compare(std::span<const double> a, std::span<const double> b);

/// The rows, each a function that prints a table.
void measure_step();      ///< Updates from an edit to the settled light.
void measure_cost();      ///< A lights-only update compared to a full one.
void measure_curve();     ///< A light step at a quarter of the full budget.
void measure_rest();      ///< Fluctuation of light at rest.
void measure_moving();    ///< Rays that the schedule saves near a moving object.
void measure_adaptive();  ///< Rays to equal error, adaptive and uniform.
void measure_house();     ///< Probes that an edit updates, and those that it should.
void measure_growth();    ///< Cost of a frame as the world grows.
void measure_scroll();    ///< Visible changes when cascades follow a walking viewer.

}  // namespace lambent::dynamics
