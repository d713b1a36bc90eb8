// SPDX-License-Identifier: Apache-2.0
// What the measurements of a field in motion share: a scene that is edited, what a camera sees of
// it, and how far two answers of fields are apart.
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
  /// A built-in scene or a file; with a sun and a sky where it brings no light.
  Subject(const std::string& name, const FieldSettings& settings);

  /// A field of the same grid that knows nothing yet.
  IrradianceField fresh_field(const FieldSettings& settings) const;
  /// What a field of the same grid settles to over the scene as it is now: many updates of many
  /// rays.
  IrradianceField settled_field() const;
  /// Tells the world of what was edited.
  void apply_edits();
  /// Moves an instance, named or, where none is called so, the last.
  void move(const std::string& instance, const glm::vec3& by);

  Scene scene;
  Bounds bounds;  ///< Open bounds before any edit.
  World world;
  IrradianceField field;
};

/// Points that the scene's first camera sees, one a pixel of a small picture.
std::vector<FieldQuery> seen_points(const Subject& subject, int pixels_across);

/// Luminance of the field's irradiance at points.
std::vector<double> light_at(const IrradianceField& field, std::span<const FieldQuery> points);
/// The same of the path tracer, with so many samples a point.
std::vector<double> reference_light_at(const World& world, std::span<const FieldQuery> points,
                                       int samples);

struct Difference {
  double mean_ratio = 0.0;     ///< Of a's mean to b's.
  double relative_rmse = 0.0;  ///< Root mean square of a - b over b's mean.
};
Difference compare(std::span<const double> a, std::span<const double> b);

/// The rows, each a function that prints a table.
void measure_step();      ///< Updates from an edit to the settled light.
void measure_cost();      ///< A lights-only update against a full one.
void measure_curve();     ///< A light step at a quarter of the full budget.
void measure_rest();      ///< How much light at rest wavers.
void measure_moving();    ///< Rays that the schedule saves beside a moving object.
void measure_adaptive();  ///< Rays to equal error, adaptive against uniform.
void measure_house();     ///< Probes that an edit touches against those it should.
void measure_growth();    ///< Cost of a frame as the world grows.
void measure_scroll();    ///< What is seen of cascades that follow a walking viewer.

}  // namespace lambent::dynamics
