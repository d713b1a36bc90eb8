// SPDX-License-Identifier: Apache-2.0
// The irradiance that rays gather at a point at which corrections are learned, and the choice of
// the next point, in the common subset of C++ and GLSL. The includer provides the type
//   GathersRef  the rays of some points
// and
//   vec3 fetch_direction(GathersRef gathers, uint ray)
//   ShadedHitRecord fetch_hit(GathersRef gathers, uint ray)
//   vec3 fetch_radiance(GathersRef gathers, uint ray)
//       gathered_radiance() of the ray's hit

/// The irradiance that a point's rays gather.
struct GatheredLuminance {
  float luminance;  ///< Luminance of the irradiance [W/m^2].
  float variance;   ///< Variance of `luminance`, estimated from its rays [(W/m^2)^2].
};

/// Irradiance that the kTrainingRays rays of a point gather. `first` is the index of the first one.
LAMBENT_FN GatheredLuminance gathered_luminance(GathersRef gathers, uint first, vec3 normal_ws,
                                                vec3 geometric_normal_ws, float gi_share) {
  vec3 sum = vec3(0.0f);
  float squares = 0.0f;
  for (uint ray = first; ray < first + uint(kTrainingRays); ++ray) {
    // Below the surface there is no light
    if (dot(geometric_normal_ws, fetch_direction(gathers, ray)) <= 0.0f) continue;
    vec3 radiance = fetch_radiance(gathers, ray);
    float level = luminance(radiance);
    sum += radiance;
    squares += level * level;
  }
  float level = luminance(sum);
  float scale =
      (kPi / float(kTrainingRays)) * above_horizon(gi_share, dot(normal_ws, geometric_normal_ws));
  GatheredLuminance gathered = {
      level * scale, variance_of_sum(level, squares, uint(kTrainingRays)) * (scale * scale)};
  return gathered;
}

/// Picks one of a point's rays that hit a surface which reflects the field's light, each with the
/// same probability. `first` is the index of the point's first ray. Returns kNoTrainingRay where
/// there is none.
LAMBENT_FN uint following_ray(GathersRef gathers, uint first, uint point, uint number, uint seed) {
  RandomStream random = make_random_stream(point, number, seed ^ kTrainingFollows);
  uint follows = kNoTrainingRay;
  float found = 0.0f;
  for (uint ray = first; ray < first + uint(kTrainingRays); ++ray) {
    ShadedHitRecord hit = fetch_hit(gathers, ray);
    if (hit.albedo_over_pi == vec3(0.0f) || hit.gi_share <= 0.0f) continue;
    found += 1.0f;
    if (next_uniform(random) * found < 1.0f) follows = ray;
  }
  return follows;
}
