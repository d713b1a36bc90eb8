// SPDX-License-Identifier: Apache-2.0
#include "field/transport/anderson.h"

#include <Eigen/Dense>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "field/transport/anderson_math.h"

namespace lambent {
namespace {

constexpr std::size_t kTexelsPerTask = 16384;

constexpr std::size_t kDepth = kAndersonDepth;
// kAndersonRidge in double precision.
constexpr double kRidge = 1e-10;

}  // namespace

double inner_product(const WorkingIrradiance& a, const WorkingIrradiance& b) {
  return parallel_sum(a.size(), kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += glm::dot(a[i], b[i]);
    return sum;
  });
}

double norm(const WorkingIrradiance& a) {
  return std::sqrt(inner_product(a, a));
}

void add_scaled(const WorkingIrradiance& a, float scale, const WorkingIrradiance& b,
                WorkingIrradiance& result) {
  parallel_chunks(a.size(), kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = a[i] + scale * b[i];
  });
}

void AndersonMemory::push(WorkingIrradiance residual_change, WorkingIrradiance image_change) {
  if (residual_changes_.size() == kDepth) {
    residual_changes_.erase(residual_changes_.begin());
    image_changes_.erase(image_changes_.begin());
  }
  residual_changes_.push_back(std::move(residual_change));
  image_changes_.push_back(std::move(image_change));
}

void AndersonMemory::extrapolate(const WorkingIrradiance& residual, WorkingIrradiance& next) const {
  const auto steps = static_cast<Eigen::Index>(residual_changes_.size());
  assert(static_cast<float>(kRidge) == kAndersonRidge);
  if (steps == 0) return;
  Eigen::MatrixXd gram(steps, steps);
  Eigen::VectorXd projection(steps);
  for (Eigen::Index i = 0; i < steps; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram(i, j) = gram(j, i) = inner_product(residual_changes_[i], residual_changes_[j]);
    }
    projection(i) = inner_product(residual_changes_[i], residual);
  }
  const double largest = gram.diagonal().maxCoeff();
  if (largest <= 0.0) return;
  gram.diagonal().array() += kRidge * largest;
  const Eigen::VectorXd coefficients = gram.ldlt().solve(projection);
  for (Eigen::Index i = 0; i < steps; ++i) {
    add_scaled(next, -static_cast<float>(coefficients(i)), image_changes_[i], next);
  }
}

}  // namespace lambent
