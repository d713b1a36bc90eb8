// SPDX-License-Identifier: Apache-2.0
// The room that the example lights, and what Lambent itself says of its light.
#pragma once

#include <lambent/field.h>
#include <lambent/scene.h>

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine.h"

/// As engine_shade.comp.glsl has it.
struct Wall {
  glm::vec3 normal, albedo;
};

struct Room {
  std::vector<WallShape> shapes;
  std::vector<Wall> walls;  ///< One a shape.
  lambent::Bounds bounds;
  glm::vec3 lamp_ws;
  float lamp_intensity;           ///< [W/sr]
  std::vector<glm::vec3> points;  ///< On walls, each followed by the normal there.
};

/// Two metres each way; one wall red, one green, a lamp below the ceiling.
Room make_room();

/// Whether this is the light at the points, as Lambent's field on the processor finds it in the
/// same room, with the same settings and viewer. Says by how much it is not.
bool is_as_expected(const Room& room, const lambent::FieldSettings& settings,
                    const glm::vec3& viewer_ws, std::span<const glm::vec3> irradiance);
