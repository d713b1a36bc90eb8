// SPDX-License-Identifier: Apache-2.0
// How well the last rays of a probe know the light before an edit, and after it: both estimates
// have the errors of the same rays, as far as the edit left what these hit alone.
#ifndef LAMBENT_FIELD_EDITS_EDITED_LIGHT_MATH_H
#define LAMBENT_FIELD_EDITS_EDITED_LIGHT_MATH_H

#include "field/transport/surfel_math.h"
#include "shared/color.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// Light that surfels reflect of the field's varies from ray to ray by about this square of a share
// of its mean, which an edit leaves as it is: by half of the mean, as between walls of albedo 0.8
// and 0.3. Without it, probes that little direct light reaches would lose their averages to an
// invisible change of it.
const float kReflectedVariance = 0.25f;

/// Sums over the rays of a probe of direct light along each, as radiance [W/(m^2 sr), luminance]:
/// `before` an edit and `after` it, of their squares, and of the products of the two.
struct EditedLight {
  float before;
  float after;
  float before_squares;
  float after_squares;
  float products;
  float rays;  ///< How many rays.
};

/// Luminance of the direct or sky light that a probe receives along a ray, from its surfel.
LAMBENT_FN float ray_light(uint kind, vec3 albedo_over_pi, vec3 light) {
  vec4 sent = sent_radiance(kind, albedo_over_pi, light, true);
  return sent.w * luminance(vec3(sent));
}

LAMBENT_FN EditedLight add_ray(EditedLight sums, float before, float after) {
  sums.before += before;
  sums.after += after;
  sums.before_squares += before * before;
  sums.after_squares += after * after;
  sums.products += before * after;
  sums.rays += 1.0f;
  return sums;
}

/// Variances and covariance of the estimates of a probe's light before and after an edit by its
/// last rays, as shares of what these estimate. All are 0 where there is no light.
struct EstimateVariance {
  float before;
  float after;
  float covariance;
};

/// `held` is the luminance of the probe's irradiance before the edit [W/m^2], a mean over its
/// texels. What of it is not direct light is the same along all rays, and after the edit.
LAMBENT_FN EstimateVariance estimate_variance(EditedLight sums, float held) {
  float rays = max(sums.rays, 1.0f);
  float reflected = max(held / kPi - sums.before / rays, 0.0f);
  float before = sums.before + rays * reflected;
  float after = sums.after + rays * reflected;
  EstimateVariance variance = EstimateVariance(0.0f, 0.0f, 0.0f);
  if (!(before > 0.0f && after > 0.0f)) return variance;
  float known = rays * reflected * reflected * (1.0f + kReflectedVariance);
  float p = 1.0f / before, q = 1.0f / after, uniform_light = 1.0f / rays;
  variance.before =
      p * p * (sums.before_squares + 2.0f * reflected * sums.before + known) - uniform_light;
  variance.after =
      q * q * (sums.after_squares + 2.0f * reflected * sums.after + known) - uniform_light;
  variance.covariance =
      p * q * (sums.products + reflected * (sums.before + sums.after) + known) - uniform_light;
  variance.before = max(variance.before, 0.0f);
  variance.after = max(variance.after, 0.0f);
  return variance;
}

/// The number of updates whose average has the variance that is left of an average of `samples`,
/// once an edit has multiplied it by the ratio of the two estimates. `share` is the history_share()
/// of the probe. Averages that start anew stay so.
LAMBENT_FN float samples_after_edit(float samples, EstimateVariance variance, float share) {
  float of_ratio = max(variance.before + variance.after - 2.0f * variance.covariance, 0.0f);
  float left = variance.before / max(samples, 1.0f) + of_ratio;
  float now = left > 0.0f ? min(samples, variance.after / left) : samples;
  return max(now * share * share, min(samples, 1.0f));
}

LAMBENT_END
#endif
