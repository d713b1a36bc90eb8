// SPDX-License-Identifier: Apache-2.0
// The noise that edits add to averages. An edit multiplies the average of a probe by the ratio of
// two estimates by the same rays: the light after the edit over the light before it. See "Edits
// touch what they change" in docs/dynamics.md.
#ifndef LAMBENT_FIELD_EDITS_EDITED_LIGHT_MATH_H
#define LAMBENT_FIELD_EDITS_EDITED_LIGHT_MATH_H

#include "field/transport/surfel_math.h"
#include "shared/color.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// The variance from ray to ray of the light that surfels reflect of the field, over the square of
// its mean: it varies by half, as between walls of albedo 0.8 and 0.3. Without it, probes that
// hardly any direct light reaches would lose their averages to an invisible change of it.
const float kReflectedVariance = 0.25f;
// A probe whose rays bring less light than this in all has none [W/(m^2 sr)]: squares of smaller
// numbers are not accurate.
const float kLeastEditedLight = 1e-15f;

/// Sums over those rays of a probe that count, of the luminance of direct light along each
/// [W/(m^2 sr)].
struct EditedLight {
  float before;          ///< Before an edit.
  float after;           ///< After the edit.
  float before_squares;  ///< Of the squares of the light before the edit.
  float after_squares;   ///< Of the squares of the light after it.
  float products;        ///< Of the products of both.
  float rays;            ///< Number of rays.
};

/// Luminance of the direct or sky light that a probe receives along a ray, from its surfel; 0 where
/// the ray does not count.
LAMBENT_FN float ray_light(uint kind, vec3 albedo_over_pi, vec3 light) {
  vec4 sent = sent_radiance(kind, albedo_over_pi, light, true);
  return sent.w * luminance(vec3(sent));
}

/// Adds a ray that met a surfel of this kind after the edit.
LAMBENT_FN EditedLight add_ray(EditedLight sums, uint kind, float before, float after) {
  if (kind == kSurfelSolidSide) return sums;
  sums.before += before;
  sums.after += after;
  sums.before_squares += before * before;
  sums.after_squares += after * after;
  sums.products += before * after;
  sums.rays += 1.0f;
  return sums;
}

/// Variances and covariance of the estimates of a probe's light before and after an edit by its
/// last rays, over the squares and the product of what these estimate.
struct EstimateVariance {
  float before;
  float after;
  float covariance;
};

/// `held` and `now` are the luminances of the probe's irradiance before and after the edit [W/m^2],
/// means over its texels. What of them is not direct light varies from ray to ray in the same way
/// before and after. Without light, all are 0.
LAMBENT_FN EstimateVariance estimate_variance(EditedLight sums, float held, float now) {
  float rays = max(sums.rays, 1.0f);
  float reflected_before = max(held / kPi - sums.before / rays, 0.0f);
  float reflected_after = max(now / kPi - sums.after / rays, 0.0f);
  float before = sums.before + rays * reflected_before;
  float after = sums.after + rays * reflected_after;
  EstimateVariance variance = {0.0f, 0.0f, 0.0f};
  if (before < kLeastEditedLight || after < kLeastEditedLight) return variance;
  // Sums of squares and products of all light along each ray
  float reflected_squares = rays * (1.0f + kReflectedVariance);
  float before_squares = sums.before_squares + 2.0f * reflected_before * sums.before +
                         reflected_squares * reflected_before * reflected_before;
  float after_squares = sums.after_squares + 2.0f * reflected_after * sums.after +
                        reflected_squares * reflected_after * reflected_after;
  float products = sums.products + reflected_after * sums.before + reflected_before * sums.after +
                   reflected_squares * reflected_before * reflected_after;
  float per_before = 1.0f / before, per_after = 1.0f / after;
  variance.before = per_before * per_before * before_squares - 1.0f / rays;
  variance.after = per_after * per_after * after_squares - 1.0f / rays;
  variance.covariance = per_before * per_after * products - 1.0f / rays;
  return variance;
}

/// The number of updates whose average is as noisy as one of `samples` updates that an edit has
/// multiplied by the ratio of the two estimates:
///   +---------------------------------------------+
///   |  n' = n / (1 + n Var(q/p) / Var(q))         |
///   |  Var(q/p) = Var(p) + Var(q) - 2 Cov(p, q)   |
///   +---------------------------------------------+
/// where p and q are the light along a ray before and after the edit, with relative variances, to
/// first order (Cochran, "Sampling Techniques", 3rd ed., 1977, sec. 6.4). The average is taken to
/// be as noisy as n updates of the light after the edit, and to be independent of the last rays,
/// although it contains them: n' is a little too small.
LAMBENT_FN float samples_after_ratio(float samples, EstimateVariance variance) {
  float of_ratio = max(variance.before + variance.after - 2.0f * variance.covariance, 0.0f);
  float of_light = max(variance.after, 0.0f);
  if (samples <= 1.0f || of_ratio <= 0.0f) return samples;
  return max(samples * of_light / (of_light + samples * of_ratio), 1.0f);
}

/// The number of samples that an average counts as after an edit that is visible in it. `likeness`
/// is the similarity, as of likeness_of(), of the light after the edit to the light before it,
/// times the history_share(). Averages that start anew stay so.
LAMBENT_FN float samples_after_edit(float samples, EstimateVariance variance, float likeness) {
  float noise_left = samples_after_ratio(samples, variance);
  return max(min(noise_left, samples * likeness * likeness), min(samples, 1.0f));
}

LAMBENT_END
#endif
