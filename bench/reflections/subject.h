// SPDX-License-Identifier: Apache-2.0
// Common parts of the measurements of reflections: scenes with a lit field, their pictures and
// references.
#pragma once

#include "core/image/metrics.h"
#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/scene.h"
#include "lambent/world.h"

namespace lambent::reflections {

/// Samples of each pixel of a picture, and of its reference.
struct Samples {
  int ours, reference;
};

inline constexpr int kSide = 128;          ///< Of most pictures [pixels].
inline constexpr float kViewAngle = 0.5f;  ///< Vertical, of views of the plate [rad].
/// Their samples and their references' paths, whose noise is taken out of errors. With few samples
/// the edges of a lamp in a mirror, which is seventeen times as bright as white, are all of the
/// error.
inline constexpr Samples kSamples{64, 512};

/// A scene with a field.
struct Subject {
  static constexpr int kSettled = 16;  ///< Updates after which light has settled.
  explicit Subject(Scene made, const FieldSettings& settings = {}, int updates = kSettled);
  Scene scene;
  World world;
  IrradianceField field;
};

/// A grey room with a red wall behind the camera, lit by a lamp and its bounces; a plate of metal
/// stands at its far end.
Scene room_with_plate(const Material& plate);

/// A metal, almost white.
Material metal(float roughness);

/// What coats reflect in a picture of quality "high", and in the reference.
struct Reflected {
  Image ours, reference, standard_error;
};

Reflected reflected_in(const Subject& subject, const Camera& camera, int side,
                       const Samples& samples);

/// The rows; each prints a table.
void measure_spheres();  ///< Error by roughness.
void measure_ramps();    ///< Steps between neighbouring roughnesses.
void measure_cells();    ///< What a mirror shows of the field's cells.
void measure_moved();    ///< Ghosts in a mirror of what moved and of a lamp that went out.

}  // namespace lambent::reflections
