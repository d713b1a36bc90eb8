// SPDX-License-Identifier: Apache-2.0
// Radiance of the sky, in the common subset of C++ and GLSL. The includer provides the types
//   MapRef          a latitude-longitude map, with its width and height [texels]
//   EnvironmentRef  with radiance, rotation and map; the map is 0 wide where there is none
// and
//   vec3 fetch_map(MapRef map, int x, int y)

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
  return environment.radiance * sample_environment_map(environment.map, uv);
}
