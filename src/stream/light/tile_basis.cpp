// SPDX-License-Identifier: Apache-2.0
#include "stream/light/tile_basis.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "field/probes/tile.h"

namespace lambent::stream {
namespace {

// A polynomial counts as independent if at least this share of it remains after its projection onto
// the basis is subtracted: far above rounding, and far below the remainder of any independent one.
constexpr double kNew = 1e-4;

using Values = std::vector<double>;  // at all texels

double dot(const Values& a, const Values& b) {
  double sum = 0.0;
  for (std::size_t t = 0; t < a.size(); ++t) sum += a[t] * b[t];
  return sum;
}

/// x^i y^j z^k at the texels' centres.
Values monomial(int edge, int i, int j, int k) {
  Values values;
  for (int texel = 0; texel < edge * edge; ++texel) {
    const vec3 d = tile_direction(ivec2(texel % edge, texel / edge), edge);
    values.push_back(std::pow(d.x, i) * std::pow(d.y, j) * std::pow(d.z, k));
  }
  return values;
}

/// Subtracts the projection onto the basis from `values`, and normalises the remainder. Returns
/// whether there was one.
bool orthonormalise(const std::vector<Values>& basis, Values& values) {
  const double before = std::sqrt(dot(values, values));
  // Twice, since the first pass's rounding error is not small compared to a small remainder
  for (int pass = 0; pass < 2; ++pass) {
    for (const Values& other : basis) {
      const double share = dot(values, other);
      for (std::size_t t = 0; t < values.size(); ++t) values[t] -= share * other[t];
    }
  }
  const double rest = std::sqrt(dot(values, values));
  if (!(rest > kNew * before)) return false;
  for (double& value : values) value /= rest;
  return true;
}

}  // namespace

TileBasis::TileBasis(int edge) : size_(static_cast<std::size_t>(edge) * edge) {
  std::vector<Values> basis;
  const auto add = [&](int i, int j, int k) {
    if (basis.size() == size_) return;
    Values values = monomial(edge, i, j, k);
    if (orthonormalise(basis, values)) basis.push_back(std::move(values));
  };
  // On the sphere z^2 = 1 - x^2 - y^2, so that higher powers of z are dependent
  const int degrees = 4 * edge;
  for (int degree = 0; degree < degrees; ++degree) {
    for (int k = 0; k <= std::min(degree, 1); ++k) {
      for (int i = degree - k; i >= 0; --i) add(i, degree - k - i, k);
    }
  }
  // Complete the basis with single texels where polynomials of these degrees do not suffice
  for (std::size_t texel = 0; texel < size_ && basis.size() < size_; ++texel) {
    Values values(size_, 0.0);
    values[texel] = 1.0;
    if (orthonormalise(basis, values)) basis.push_back(std::move(values));
  }
  assert(basis.size() == size_);
  for (const Values& function : basis) {
    values_.insert(values_.end(), function.begin(), function.end());
  }
  for (std::size_t texel = 0; texel < size_; ++texel) {
    for (const Values& function : basis) transposed_.push_back(static_cast<float>(function[texel]));
  }
}

}  // namespace lambent::stream
