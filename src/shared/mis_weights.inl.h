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

/// Density with which samples of lights find what a ray found [1/sr]: an emitter of this `level`
/// above 0, where they find one with `scale` times its level; or, below 0, the sky, with -`level`.
LAMBENT_REAL_FN Real sampled_density(Real level, Real scale) {
  return select(level > 0.0f, level * scale, level * -1.0f);
}

/// Weight of light that a coat's ray found, drawn with density `pdf`, where samples of lights find
/// it with `density`, that of one times their number [1/sr]. The sums of both remain unbiased for
/// any densities.
LAMBENT_REAL_FN Real found_light_weight(Real pdf, Real density) {
  return select(pdf > 0.0f, mis_power_weight(pdf, density), 0.0f);
}
