// SPDX-License-Identifier: Apache-2.0
#include "field/probes/tile_fit.h"

#include <Eigen/Dense>
#include <map>
#include <mutex>

#include "field/probes/tile.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

constexpr int kHarmonics = 9;  // degrees 0 to 2

// Where a tile has too few texels to distinguish all harmonics, the constant one takes precedence:
// it is scaled by this factor, so that the pseudo-inverse, which minimises coefficients, prefers
// it.
constexpr double kConstantFirst = 1e4;

// Directions of the quadrature over the sphere: at least 64 for each of at most 256 texels.
constexpr int kQuadratureDirections = 16384;

/// Real spherical harmonics up to degree 2 without their constant factors, which the fit does not
/// depend on.
Eigen::Matrix<double, kHarmonics, 1> harmonics(const vec3& n) {
  const double x = n.x, y = n.y, z = n.z;
  Eigen::Matrix<double, kHarmonics, 1> values;
  values << 1.0, x, y, z, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y;
  return values;
}

std::vector<float> compute_fit(int edge) {
  const int texels = edge * edge;

  // Integrate the products of the fetch weights with themselves and with the harmonics
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(texels, texels);
  Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(texels, kHarmonics);
  for (int i = 0; i < kQuadratureDirections; ++i) {
    const vec3 direction = spherical_fibonacci(i, kQuadratureDirections);
    const TileFetch fetch = tile_fetch(direction, edge);
    const auto basis = harmonics(direction);
    int index[4];
    double weight[4];
    for (int tap = 0; tap < 4; ++tap) {
      const ivec2 offset(tap & 1, tap >> 1);
      const ivec2 source = tile_source(fetch.corner + offset, edge);
      index[tap] = source.x + edge * source.y;
      weight[tap] = (offset.x == 1 ? fetch.fraction.x : 1.0f - fetch.fraction.x) *
                    (offset.y == 1 ? fetch.fraction.y : 1.0f - fetch.fraction.y);
    }
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) gram(index[a], index[b]) += weight[a] * weight[b];
      projection.row(index[a]) += weight[a] * basis.transpose();
    }
  }

  // Compute the harmonics at the texels' centres, and the stored values that interpolate to them
  // best
  Eigen::MatrixXd centres(texels, kHarmonics);
  for (int t = 0; t < texels; ++t) {
    centres.row(t) = harmonics(tile_direction({t % edge, t / edge}, edge)).transpose();
  }
  const Eigen::MatrixXd best = gram.ldlt().solve(projection);

  Eigen::VectorXd scale = Eigen::VectorXd::Ones(kHarmonics);
  scale(0) = kConstantFirst;
  const Eigen::MatrixXd scaled = centres * scale.asDiagonal();
  const Eigen::MatrixXd fit = Eigen::MatrixXd::Identity(texels, texels) +
                              (best - centres) * scale.asDiagonal() *
                                  scaled.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::MatrixXf rounded = fit.cast<float>();
  return {rounded.data(), rounded.data() + rounded.size()};
}

}  // namespace

std::vector<float> tile_fit_matrix(int edge) {
  // Fields are made often, as from streams, and in few sizes
  static std::mutex mutex;
  static std::map<int, std::vector<float>> computed;
  const std::lock_guard lock(mutex);
  std::vector<float>& fit = computed[edge];
  if (fit.empty()) fit = compute_fit(edge);
  return fit;
}

}  // namespace lambent
