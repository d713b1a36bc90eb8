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

struct GatherGuide;

/// Pixels of some rows of a picture, and how their light is gathered.
struct GatherRequest {
  std::span<const Surface> surfaces;   ///< Undefined where `seen` is 0.
  std::span<const std::uint8_t> seen;  ///< 1 where the pixel shows a surface.
  int width = 0;                       ///< Width of a row [pixels].
  int first_row = 0;                   ///< First row, counted in the picture.
  int rays_per_pixel = 1;              ///< >= 1.
  std::uint32_t sample = 0;            ///< Index of the sample; each has other rays.
  std::uint32_t seed = 1;
  /// Irradiance from lookups of the field at each pixel; empty: no excess is split off.
  std::span<const glm::vec3> known = {};
  const GatherGuide* guide = nullptr;  ///< Null: no rays are guided.
};

/// The gathered light, one element a pixel.
struct GatheredLight {
  std::vector<glm::vec3> irradiance;  ///< [W/m^2]; 0 where nothing is seen.
  /// Variance of the irradiance's luminance; empty where a pixel has one ray, which has none to
  /// measure.
  std::vector<float> variance;
  /// Irradiance that rays add beyond kBrightestRay times known_level(); `irradiance` does not
  /// include it. Empty where `known` is.
  std::vector<glm::vec3> excess;
};

/// Gathers the pixels' irradiance. Returns the number of rays traced, including shadow rays.
std::uint64_t gather_irradiance(const World& world, const IrradianceField& field,
                                const GatherRequest& request, GatheredLight& light);

}  // namespace lambent
