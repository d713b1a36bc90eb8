// SPDX-License-Identifier: Apache-2.0
// Formulas of blurs that keep the edges of surfaces and relight what they blur (in C++ also for
// several pixels, in the lanes of a vector), in the common subset of C++ and GLSL. Without an
// include guard. cross_bilateral.h and reorient_irradiance.h derive them. The includer provides
//   Real             float, or lanes of them with the same operators
//   LAMBENT_REAL_FN  before a function
//   Real min(Real, Real), Real max(Real, Real)
//   Real select(condition, Real yes, Real no)   see lang.h

/// relit_bilateral_weight() for normals with this cosine between them, and a distance from the
/// pixel's plane of `beyond` times the tolerance.
LAMBENT_REAL_FN Real relit_weight(Real cosine, Real beyond) {
  Real square = cosine * cosine;
  Real fourth = square * square;
  Real near = 1.0f - beyond * beyond;
  Real weight = (fourth * fourth) * (fourth * fourth) * near;
  return select(min(cosine, near) > 0.0f, weight, 0.0f);
}

/// The factor by which reorientation() scales a direction, given the pixel's luminance, the cosine
/// between normal and direction times the latter's length, and that length.
LAMBENT_REAL_FN Real direction_scale(Real light, Real across, Real direction_length) {
  Real bound = max(across, direction_length * kLeastDirectedCosine);
  Real scale = light / bound;
  return select(bound > light * kLeastDirectedShare, scale, 0.0f);
}

/// What reorientation() adds along the normal.
LAMBENT_REAL_FN Real reorientation_along_normal(Real light, Real across, Real scale) {
  return light * (1.0f - kHorizonLight) - across * scale;
}

/// reoriented_fraction(), given the product of mean R and normal.
LAMBENT_REAL_FN Real reoriented_share(Real reoriented, Real light) {
  Real fraction = reoriented / light + kHorizonLight;
  return select(min(fraction, light) > 0.0f, fraction, 0.0f);
}
