// SPDX-License-Identifier: Apache-2.0
// Final gathering: indirect light of a pixel from rays of its own, whose hits the irradiance field
// lights.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lambent/field.h"
#include "lambent/world.h"
#include "raytracing/surface.h"

namespace lambent {

/// Pixels of some rows of a picture, and how their light is gathered.
struct GatherRequest {
  std::span<const Surface> surfaces;   ///< Undefined where `seen` is 0.
  std::span<const std::uint8_t> seen;  ///< 1 where a surface is.
  int width = 0;                       ///< Pixels of a row.
  int first_row = 0;                   ///< Of the picture.
  int rays_per_pixel = 1;              ///< >= 1.
  std::uint32_t sample = 0;            ///< Which of the pixel's samples; no two have the same rays.
  std::uint32_t seed = 1;
  /// Irradiance that the field knows at each pixel; empty: nothing is kept apart as excess.
  std::span<const glm::vec3> known = {};
};

/// What the rays of pixels brought, an element a pixel.
struct GatheredLight {
  std::vector<glm::vec3> irradiance;  ///< [W/m^2]; 0 where nothing is seen.
  /// Of the irradiance's luminance; empty where pixels have one ray, which tells nothing of it.
  std::vector<float> variance;
  /// What rays brought that are far brighter than the light known there, and `irradiance` is
  /// without; empty where there are none.
  std::vector<glm::vec3> excess;
};

/// Returns the rays traced, shadow rays included.
std::uint64_t gather_irradiance(const World& world, const IrradianceField& field,
                                const GatherRequest& request, GatheredLight& light);

}  // namespace lambent
