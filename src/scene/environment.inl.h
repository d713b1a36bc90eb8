// SPDX-License-Identifier: Apache-2.0
// Radiance of the sky, in the common subset of C++ and GLSL. The includer provides the types
//   MapRef          a latitude-longitude map, with its width and height [texels]
//   EnvironmentRef  with radiance, rotation and map; the map is 0 wide where there is none
//   SkyRef          the same with ever coarser levels of the map
// and
//   vec3 fetch_map(MapRef map, int x, int y)
//   MapRef map_of(EnvironmentRef environment)
//   EnvironmentRef environment_of(SkyRef sky)
//   MapRef map_level(SkyRef sky, int level)   of map_level_count() levels; 0 is the map

/// A map read bilinearly; wraps around in u, clamps in v.
LAMBENT_FN vec3 sample_environment_map(MapRef map, vec2 uv) {
  MapTexels t = map_texels(uv, map.width, map.height);
  vec3 above = mix(fetch_map(map, t.left, t.top), fetch_map(map, t.right, t.top), t.fraction.x);
  vec3 below =
      mix(fetch_map(map, t.left, t.bottom), fetch_map(map, t.right, t.bottom), t.fraction.x);
  return mix(above, below, t.fraction.y);
}

/// Radiance of the sky in a unit direction [W/(m^2 sr)].
LAMBENT_FN vec3 sky_radiance(EnvironmentRef environment, vec3 direction_ws) {
  if (environment.map.width == 0) return environment.radiance;
  vec2 uv = latitude_longitude_from_direction(direction_ws, environment.rotation);
  return environment.radiance * sample_environment_map(map_of(environment), uv);
}

/// Radiance of the sky around a unit direction, over a cone of this angle [rad]: what a ray that
/// was drawn of a lobe stands for (ray_cone.h). Two levels of the map are blended, as of textures.
LAMBENT_FN vec3 sky_radiance_in_cone(SkyRef sky, vec3 direction_ws, float angle) {
  EnvironmentRef environment = environment_of(sky);
  if (environment.map.width == 0) return environment.radiance;
  BlendedLevels levels = levels_of_cone(environment.map.height, angle);
  vec2 uv = latitude_longitude_from_direction(direction_ws, environment.rotation);
  vec3 radiance = sample_environment_map(map_level(sky, levels.finer), uv);
  if (levels.fraction > 0.0f) {
    vec3 coarser = sample_environment_map(map_level(sky, levels.coarser), uv);
    radiance = mix(radiance, coarser, levels.fraction);
  }
  return environment.radiance * radiance;
}
