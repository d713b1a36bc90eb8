// SPDX-License-Identifier: Apache-2.0
// The bright part of the sky, in the common subset of C++ and GLSL. Besides what environment.inl.h
// requires, the includer provides
//   float bright_limit(SkyRef sky)      see SkyLevels, also for the next
//   float bright_total(SkyRef sky)
//   uint bright_cell_count(SkyRef sky)  0: the sky has no bright part
//   BrightSkyCell fetch_bright_cell(SkyRef sky, uint cell)
//   MapRef dim_level(SkyRef sky, int level)   from level 1 on
#include "scene/environment.inl.h"

/// Radiance of the bright part of a map, read as sample_environment_map() reads it.
LAMBENT_FN vec3 sample_bright_map(MapRef map, float limit, vec2 uv) {
  MapTexels t = map_texels(uv, map.width, map.height);
  vec3 above = mix(bright_part(fetch_map(map, t.left, t.top), limit),
                   bright_part(fetch_map(map, t.right, t.top), limit), t.fraction.x);
  vec3 below = mix(bright_part(fetch_map(map, t.left, t.bottom), limit),
                   bright_part(fetch_map(map, t.right, t.bottom), limit), t.fraction.x);
  return mix(above, below, t.fraction.y);
}

/// The weight with which a texel's area is drawn: its solid angle times the mean luminance of the
/// bright part. Interpolation brings light of its neighbours there: along each axis, the texels
/// before it, at it and after it have shares of 1/8, 6/8 and 1/8.
LAMBENT_FN float bright_weight(MapRef map, float limit, int x, int y) {
  float sum = 0.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      float share = (dx == 0 ? 0.75f : 0.125f) * (dy == 0 ? 0.75f : 0.125f);
      vec3 texel =
          fetch_map(map, (x + dx + map.width) % map.width, clamp(y + dy, 0, map.height - 1));
      sum += share * luminance(bright_part(texel, limit));
    }
  }
  return sum * sin(kPi * (float(y) + 0.5f) / float(map.height));
}

/// Density over solid angle of a cell that is drawn with this probability, at the latitude of v
/// [1/sr].
LAMBENT_FN float bright_density(MapRef map, float probability, float v) {
  float angle = map_solid_angle(v);
  return angle > 0.0f ? probability * float(map.width) * float(map.height) / angle : 0.0f;
}

/// A direction drawn from the bright part of the sky.
struct BrightSkySample {
  vec3 direction_ws;  ///< Unit.
  vec3 radiance;      ///< Of the bright part alone [W/(m^2 sr)].
  float pdf;          ///< [1/sr]
};

/// Draws a direction for a number `u` that picks the cell and a point of the unit square.
LAMBENT_FN BrightSkySample sample_bright_sky(SkyRef sky, float u, vec2 within) {
  // Find the first cell whose cumulative probability is above u
  uint first = 0u;
  uint last = bright_cell_count(sky) - 1u;
  while (first < last) {
    uint middle = (first + last) / 2u;
    if (fetch_bright_cell(sky, middle).cumulative > u) {
      last = middle;
    } else {
      first = middle + 1u;
    }
  }
  BrightSkyCell cell = fetch_bright_cell(sky, first);
  EnvironmentRef environment = environment_of(sky);
  MapRef map = map_of(environment);
  uint width = uint(map.width);
  vec2 uv = vec2((float(cell.texel % width) + within.x) / float(map.width),
                 (float(cell.texel / width) + within.y) / float(map.height));
  BrightSkySample drawn = {direction_from_latitude_longitude(uv, environment.rotation),
                           environment.radiance * sample_bright_map(map, bright_limit(sky), uv),
                           bright_density(map, cell.probability, uv.y)};
  return drawn;
}

/// The sky around a unit direction, over a cone of this angle [rad]. The bright part is not
/// averaged over the cone: multiple importance sampling needs its density in one direction.
LAMBENT_FN SkySeen sky_seen(SkyRef sky, vec3 direction_ws, float angle) {
  SkySeen seen = {vec3(0.0f), vec3(0.0f), 0.0f};
  if (bright_cell_count(sky) == 0u) {
    seen.dim = sky_radiance_in_cone(sky, direction_ws, angle);
    return seen;
  }
  EnvironmentRef environment = environment_of(sky);
  MapRef map = map_of(environment);
  float limit = bright_limit(sky);
  vec2 uv = latitude_longitude_from_direction(direction_ws, environment.rotation);
  vec3 bright = sample_bright_map(map, limit, uv);
  if (bright != vec3(0.0f)) {
    int x = min(int(uv.x * float(map.width)), map.width - 1);
    int y = min(int(uv.y * float(map.height)), map.height - 1);
    seen.bright = environment.radiance * bright;
    seen.density = bright_density(map, bright_weight(map, limit, x, y) / bright_total(sky), uv.y);
  }
  BlendedLevels levels = levels_of_cone(map.height, angle);
  vec3 dim = levels.finer == 0 ? sample_environment_map(map, uv) - bright
                               : sample_environment_map(dim_level(sky, levels.finer), uv);
  if (levels.fraction > 0.0f) {
    vec3 coarser = sample_environment_map(dim_level(sky, levels.coarser), uv);
    dim = mix(dim, coarser, levels.fraction);
  }
  seen.dim = environment.radiance * max(dim, vec3(0.0f));
  return seen;
}
