// SPDX-License-Identifier: Apache-2.0
// The values to store in a tile so that bilinear reads give the right irradiance.
//
// A tile stores values c_t at its texels and is read bilinearly: E(n) ~ sum_t phi_t(n) c_t, with
// phi_t the weight that a fetch along n gives texel t. Storing the irradiance at the texels'
// centres, c_t = E(n_t), makes reads too smooth: a coarse tile loses contrast. It is most visible
// on surfaces along the axes, whose normals fall between texels.
//
// Irradiance is almost exactly a spherical harmonic expansion up to degree 2 (Ramamoorthi and
// Hanrahan, "On the Relationship between Radiance and Irradiance", JOSA A 18(10), 2001). For such
// functions, with Y the harmonics, the values that read best in the least-squares sense over the
// sphere are c = C s, where s are the coefficients,
//   C = (integral phi phi^T)^-1 (integral phi Y^T),
// while the values at the centres are v = V s, V_tk = Y_k(n_t). The map from v to c that does not
// change what the harmonics cannot represent is
//   +---------------------------------+
//   |  c = v + (C - V) V^+ v          |
//   +---------------------------------+
// a constant matrix for each size of tile.
#pragma once

#include <vector>

namespace lambent {

/// The texels x texels matrix that turns irradiance at the centres of an interior of `edge` x
/// `edge` texels into the values to store, column after column. Each size is computed once; threads
/// may call it at the same time.
std::vector<float> tile_fit_matrix(int edge);

}  // namespace lambent
