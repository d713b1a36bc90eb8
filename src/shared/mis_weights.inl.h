// SPDX-License-Identifier: Apache-2.0
// Weights of multiple importance sampling (in C++ also of several samples, in the lanes of a
// vector), in the common subset of C++ and GLSL. Without an include guard. The includer provides
//   Real             float, or lanes of them with the same operators
//   LAMBENT_REAL_FN  before a function
//   Real select(condition, Real yes, Real no)   see lang.h

/// Weight of a sample of one strategy against another's, power heuristic with exponent 2.
/// Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, sec. 9.2.
LAMBENT_REAL_FN Real mis_power_weight(Real pdf, Real other_pdf) {
  Real ratio = other_pdf / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

/// Density with which samples of lights find what a ray found [1/sr]: above 0, `found` is the
/// luminance of an emitter, which they find with `scale` times as much; below 0, it is of the sky,
/// and is minus the density itself.
LAMBENT_REAL_FN Real sampled_density(Real found, Real scale) {
  return select(found > 0.0f, found * scale, found * -1.0f);
}

/// Weight of light that a coat's ray found, drawn with density `pdf`, where samples of lights find
/// it with `density`, that of one times their number [1/sr]. The sums of both remain unbiased for
/// any densities.
LAMBENT_REAL_FN Real found_light_weight(Real pdf, Real density) {
  return select(pdf > 0.0f, mis_power_weight(pdf, density), 0.0f);
}
