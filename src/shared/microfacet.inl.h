// SPDX-License-Identifier: Apache-2.0
// Terms of microfacet lobes (in C++ also of several, in the lanes of a vector), in the common
// subset of C++ and GLSL. Without an include guard. ggx.h and brdf.h derive the rest. The includer
// provides
//   Real, Real3      float and vec3, or lanes of them with the same operators
//   LAMBENT_REAL_FN  before a function
//   Real sqrt(Real), Real min(Real, Real), Real max(Real, Real)

/// Smith's Lambda for GGX, from the cosine to the normal.
LAMBENT_REAL_FN Real smith_lambda(Real cos_theta, Real squared_alpha) {
  Real c2 = cos_theta * cos_theta;
  Real tan2 = max(0.0f, 1.0f - c2) / max(c2, 1e-12f);
  return 0.5f * (sqrt(1.0f + squared_alpha * tan2) - 1.0f);
}

/// Schlick's (1 - cos)^5.
LAMBENT_REAL_FN Real schlick_power(Real cosine) {
  Real m = min(max(1.0f - cosine, 0.0f), 1.0f);
  return m * m * m * m * m;
}

/// Reflectance between those at normal and at grazing incidence, for a value of schlick_power().
LAMBENT_REAL_FN Real3 schlick_reflectance(Real3 f0, Real f90, Real power) {
  return f0 + (Real3(f90) - f0) * power;
}
