// SPDX-License-Identifier: Apache-2.0
// Multi-bounce light that fog scatters, from a field's irradiance. Derived in docs/math.md.
// Based on: Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment
// Maps", SIGGRAPH 2001 (irradiance is radiance convolved with a cosine).
#ifndef LAMBENT_FOG_AMBIENT_H
#define LAMBENT_FOG_AMBIENT_H

#include "field/lookup/lookup.h"
#include "shared/constants.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// Directions in which irradiance is looked up: along the ray, against it, and across it.
const int kAmbientDirections = 6;

/// Irradiance around a ray [W/m^2]: its components in the zonal bands 0, 1 and 2 along the ray,
/// each as its value in the ray's direction.
struct AmbientIrradiance {
  vec3 mean;
  vec3 linear;
  vec3 quadratic;
  float weight;  ///< Sum of the weights of the volumes with a visible probe; 0: there is none.
};

LAMBENT_FN vec3 ambient_direction(Frame around_ray, int index) {
  if (index == 0) return around_ray.normal;
  if (index == 1) return -around_ray.normal;
  if (index == 2) return around_ray.tangent;
  if (index == 3) return -around_ray.tangent;
  if (index == 4) return around_ray.bitangent;
  return -around_ray.bitangent;
}

/// Adds the irradiance of one direction to the bands. With E(c) = b0 + b1 c + b2 (3 c^2 - 1) / 2 by
/// the cosine c to the ray, the directions give b0 + b1 + b2, b0 - b1 + b2, and four times
/// b0 - b2 / 2. Hence
/// [b0 = (E+ + E- + 4 E0) / 6, b1 = (E+ - E-) / 2, b2 = (E+ + E- - 2 E0) / 3].
LAMBENT_FN void add_ambient(LAMBENT_INOUT(AmbientIrradiance) sum, int index, vec3 irradiance,
                            float weight) {
  sum.mean += irradiance * (weight / 6.0f);
  if (index < 2) {
    sum.linear += irradiance * (index == 0 ? 0.5f * weight : -0.5f * weight);
    sum.quadratic += irradiance * (weight / 3.0f);
  } else {
    sum.quadratic -= irradiance * (weight / 6.0f);
  }
}

/// Radiance that fog of this anisotropy and a scattering albedo of 1 sends against the ray.
/// Irradiance has pi, 2 pi / 3 and pi / 4 times radiance's component of the bands 0, 1 and 2, and
/// the phase function of Henyey and Greenstein multiplies them by 1, g and g^2.
LAMBENT_FN vec3 ambient_source(AmbientIrradiance ambient, float anisotropy) {
  vec3 bands = ambient.mean + ambient.linear * (1.5f * anisotropy) +
               ambient.quadratic * (4.0f * anisotropy * anisotropy);
  return max(bands * kInvPi, vec3(0.0f));
}

LAMBENT_END
#endif
