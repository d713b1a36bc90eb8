// SPDX-License-Identifier: Apache-2.0
// Where samples of a pixel lie, the rays that gather its light, what its surface makes of light,
// and the layers that it shows.
#ifndef LAMBENT_COMPOSE_PIXEL_MATH_H
#define LAMBENT_COMPOSE_PIXEL_MATH_H

#include "raytracing/shaded_hit.h"
#include "shared/brdf.h"
#include "shared/random.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

// Keeps the random numbers of pixels' positions apart from those of other passes.
const uint kSubpixelSalt = 0x50495845u;

// Rays that gather a hemisphere's light have cones this wide per metre over the square root of
// their number: together they cover it.
const float kHemisphereConeWidth = 2.0f;

/// Where in the pixel a sample of so many lies, each coordinate 0 to 1.
LAMBENT_FN vec2 subpixel_position(uint pixel, uint index, uint samples, uint seed) {
  if (samples == 1u) return vec2(0.5f);
  RandomStream random = make_random_stream(pixel, kSubpixelSalt, seed);
  vec2 shift = next_uniform2(random);
  return fract(shift + plastic_sequence(index));
}

/// The shift of a pixel's gathering rays; no two pixels alike.
LAMBENT_FN vec2 gather_shift(uint pixel, uint index, uint seed) {
  RandomStream random = make_random_stream(pixel, index, ~seed);
  return next_uniform2(random);
}

/// Direction of one of a pixel's gathering rays, spread evenly over the cosine-weighted hemisphere.
LAMBENT_FN vec3 gather_direction(Frame frame, vec2 shift, uint ray) {
  vec2 u = fract(shift + plastic_sequence(ray));
  return to_world(frame, sample_cosine_hemisphere(u));
}

/// Radiance that a surface's base, under its coat, makes of indirect irradiance.
LAMBENT_FN vec3 reflected_indirect(Reflectance reflectance, vec3 irradiance) {
  return reflectance.diffuse * (vec3(1.0f) - reflectance.f0) * irradiance * kInvPi;
}

/// Radiance that its coat makes of the irradiance where a mirror would look; 0 without a coat.
LAMBENT_FN vec3 reflected_glossy(Reflectance reflectance, float n_dot_v, vec3 mirror_irradiance) {
  if (reflectance.f90 <= 0.0f) return vec3(0.0f);
  return specular_albedo(reflectance, n_dot_v) * mirror_irradiance * kInvPi;
}

/// Radiance that a gathering ray brings back but for what its hit emits, which is direct light.
/// `direct` and `field` are the irradiance of the hit from lights and from the field.
LAMBENT_FN vec3 gathered_radiance(ShadedHitRecord hit, vec3 direct, vec3 field) {
  bool receives_gi = (hit.flags & kSurfaceReceivesGi) != 0u;
  bool sky = (hit.flags & kSurfaceMissed) != 0u;
  return hit.albedo_over_pi * (direct + (receives_gi ? field : vec3(0.0f))) +
         (sky ? hit.radiance : vec3(0.0f));
}

/// The field's light at a pixel once another source has taken the place of a part of it.
LAMBENT_FN vec3 replaced_light(vec3 irradiance, vec3 added, vec3 subtracted_field) {
  return max(irradiance + added - subtracted_field, vec3(0.0f));
}

LAMBENT_END
#endif
