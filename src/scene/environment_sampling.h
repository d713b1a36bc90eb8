// SPDX-License-Identifier: Apache-2.0
// The sky as a light: its radiance, and directions drawn by the brightness of its map.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "lambent/scene.h"
#include "scene/latitude_longitude.h"
#include "scene/sky/sky_levels.h"

namespace lambent {

// The types and functions that environment.inl.h requires.
using MapRef = const Image&;
using EnvironmentRef = const Environment&;
using SkyRef = const SkyLevels&;

inline const Image& map_of(const Environment& environment) {
  return environment.map;
}

inline const Environment& environment_of(const SkyLevels& sky) {
  return sky.environment();
}

inline const Image& map_level(const SkyLevels& sky, int level) {
  return sky.level(level);
}

inline vec3 fetch_map(const Image& map, int x, int y) {
  const float* p = map.at(x, y);
  return {p[0], p[1], p[2]};
}

inline float bright_limit(const SkyLevels& sky) {
  return sky.bright_limit();
}

inline float bright_total(const SkyLevels& sky) {
  return sky.bright_total();
}

inline uint bright_cell_count(const SkyLevels& sky) {
  return static_cast<uint>(sky.bright_cells().size());
}

inline const BrightSkyCell& fetch_bright_cell(const SkyLevels& sky, uint cell) {
  return sky.bright_cells()[cell];
}

inline const Image& dim_level(const SkyLevels& sky, int level) {
  return sky.dim_level(level);
}

#include "scene/sky/bright_sky.inl.h"

/// A direction drawn from the sky.
struct EnvironmentSample {
  glm::vec3 direction_ws{0.0f, 1.0f, 0.0f};  ///< Unit.
  glm::vec3 radiance{0.0f};                  ///< [W/(m^2 sr)].
  float pdf = 0.0f;                          ///< Density [1/sr]; 0: the sky is black or has no map.
};

/// Draws directions with density proportional to the luminance of an environment's map.
class EnvironmentDistribution {
 public:
  /// Empty where the environment has no map: a constant sky is best sampled by the BRDF.
  explicit EnvironmentDistribution(const Environment& environment);

  bool empty() const { return row_cumulative_.empty(); }

  /// A direction for a uniform point of the unit square.
  EnvironmentSample sample(const glm::vec2& u) const;

  /// The density with which `sample` draws a unit direction [1/sr].
  float pdf(const glm::vec3& direction_ws) const;

 private:
  const Environment* environment_;
  int width_ = 0, height_ = 0;
  std::vector<float> row_cumulative_;   // height_: upper end of each row's interval of [0, 1)
  std::vector<float> cell_cumulative_;  // width_ * height_: the same for each cell in its row
};

}  // namespace lambent
