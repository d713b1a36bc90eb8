// SPDX-License-Identifier: Apache-2.0
// All fog of a scene along a ray, in the common subset of C++ and GLSL. The includer provides the
// type
//   MediaRef  boxes of fog
// and
//   uint media_count(MediaRef media)
//   MediumRecord fetch_medium(MediaRef media, uint medium)

/// The integral of the density of all fog between two distances along a ray.
LAMBENT_FN float optical_depth(MediaRef media, vec3 origin_ws, vec3 direction_ws, float from,
                               float to) {
  float sum = 0.0f;
  for (uint i = 0u; i < media_count(media); ++i) {
    sum += span_optical_depth(medium_span(fetch_medium(media, i), origin_ws, direction_ws, to),
                              from, to);
  }
  return sum;
}

/// Transmittance from a point to another one at this distance.
LAMBENT_FN float transmittance(MediaRef media, vec3 origin_ws, vec3 direction_ws, float distance) {
  return exp(-optical_depth(media, origin_ws, direction_ws, 0.0f, distance));
}

/// The interval of distances along a ray, up to `t_max`, that contains fog: from where it enters
/// the first box to where it leaves the last one. If there is none, the end is not above the begin.
LAMBENT_FN vec2 fog_range(MediaRef media, vec3 origin_ws, vec3 direction_ws, float t_max) {
  vec2 range = vec2(infinity(), 0.0f);
  for (uint i = 0u; i < media_count(media); ++i) {
    MediumSpan span = medium_span(fetch_medium(media, i), origin_ws, direction_ws, t_max);
    if (!(span.end > span.begin)) continue;
    range = vec2(min(range.x, span.begin), max(range.y, span.end));
  }
  return range;
}

/// The density of all fog at a point [1/m].
LAMBENT_FN float fog_density(MediaRef media, vec3 position_ws) {
  float sum = 0.0f;
  for (uint i = 0u; i < media_count(media); ++i) {
    sum += medium_density(fetch_medium(media, i), position_ws);
  }
  return sum;
}

/// Radiance that fog at a point scatters from `to_light` towards the viewer, per irradiance and
/// extinction: albedo times phase function [1/sr], averaged by density where boxes overlap. 0 where
/// there is no fog.
LAMBENT_FN vec3 scattering(MediaRef media, vec3 position_ws, vec3 view_direction_ws,
                           vec3 to_light) {
  float cosine = dot(view_direction_ws, to_light);
  vec3 sum = vec3(0.0f);
  float total = 0.0f;
  for (uint i = 0u; i < media_count(media); ++i) {
    MediumRecord medium = fetch_medium(media, i);
    float density = medium_density(medium, position_ws);
    sum += medium.albedo * (density * phase(medium.anisotropy, cosine));
    total += density;
  }
  return total > 0.0f ? sum / total : vec3(0.0f);
}
