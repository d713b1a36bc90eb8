// SPDX-License-Identifier: Apache-2.0
#include "field/transport/anderson.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "field/transport/anderson_math.h"

namespace lambent {
namespace {

constexpr std::size_t kTexelsPerTask = 16384;

/// A double as the sum of two floats, which holds 48 of its 53 bits.
Wide to_wide(double value) {
  const auto high = static_cast<float>(value);
  return {high, static_cast<float>(value - high)};
}

/// Calls body(begin, end) for the parts of the chunks of `size` texels that lie within
/// [first, last), in their order.
template <class Body>
void for_each_part(std::size_t first, std::size_t last, Body body) {
  while (first < last) {
    const std::size_t end = std::min(last, (first / kTexelsPerTask + 1) * kTexelsPerTask);
    body(first, end);
    first = end;
  }
}

/// Whether the part from `begin` to `end` of `size` texels is a whole chunk.
bool is_whole(std::size_t begin, std::size_t end, std::size_t size) {
  return begin % kTexelsPerTask == 0 && (end % kTexelsPerTask == 0 || end == size);
}

/// How many numbers SharedTexels::inner_product() exchanges for a part of a chunk: the sum of a
/// whole chunk, or else all products.
std::size_t numbers_of(std::size_t begin, std::size_t end, std::size_t size) {
  return is_whole(begin, end, size) ? 1 : end - begin;
}

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

SharedTexels::SharedTexels(Ranks& ranks, std::vector<std::size_t> firsts)
    : ranks_(&ranks), firsts_(std::move(firsts)), first_numbers_{0} {
  assert(firsts_.size() == static_cast<std::size_t>(ranks.count()) + 1);
  for (std::size_t r = 0; r + 1 < firsts_.size(); ++r) {
    std::size_t numbers = first_numbers_.back();
    for_each_part(firsts_[r], firsts_[r + 1], [&](std::size_t begin, std::size_t end) {
      numbers += numbers_of(begin, end, firsts_.back());
    });
    first_numbers_.push_back(numbers);
  }
}

/// A rank sums the chunks that it has as a whole. Of chunks that several ranks share, they exchange
/// all products. Every rank then adds all numbers in their order, so that the sum has the same bits
/// as on a single rank.
double SharedTexels::inner_product(const WorkingIrradiance& a, const WorkingIrradiance& b) const {
  if (ranks_->count() == 1) return lambent::inner_product(a, b);
  const auto own = static_cast<std::size_t>(ranks_->own());
  const std::size_t first = firsts_[own], size = firsts_.back();
  assert(a.size() == firsts_[own + 1] - first);
  std::vector<double> numbers(first_numbers_.back());
  double* out = numbers.data() + first_numbers_[own];
  for_each_part(first, firsts_[own + 1], [&](std::size_t begin, std::size_t end) {
    if (is_whole(begin, end, size)) {
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) sum += glm::dot(a[i - first], b[i - first]);
      *out++ = sum;
    } else {
      for (std::size_t i = begin; i < end; ++i) *out++ = glm::dot(a[i - first], b[i - first]);
    }
  });
  gather_parts(*ranks_, std::span(numbers), first_numbers_);

  double sum = 0.0, of_chunk = 0.0;
  const double* in = numbers.data();
  for (std::size_t r = 0; r + 1 < firsts_.size(); ++r) {
    for_each_part(firsts_[r], firsts_[r + 1], [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = 0; i < numbers_of(begin, end, size); ++i) of_chunk += *in++;
      if (end % kTexelsPerTask != 0 && end != size) return;
      sum += of_chunk;
      of_chunk = 0.0;
    });
  }
  return sum;
}

double SharedTexels::norm(const WorkingIrradiance& a) const {
  return std::sqrt(inner_product(a, a));
}

void add_scaled(const WorkingIrradiance& a, float scale, const WorkingIrradiance& b,
                WorkingIrradiance& result) {
  parallel_chunks(a.size(), kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = a[i] + scale * b[i];
  });
}

void AndersonMemory::push(WorkingIrradiance residual_change, WorkingIrradiance image_change) {
  if (residual_changes_.size() == std::size_t{kAndersonDepth}) {
    residual_changes_.erase(residual_changes_.begin());
    image_changes_.erase(image_changes_.begin());
  }
  residual_changes_.push_back(std::move(residual_change));
  image_changes_.push_back(std::move(image_change));
}

void AndersonMemory::extrapolate(const SharedTexels& texels, const WorkingIrradiance& residual,
                                 WorkingIrradiance& next) const {
  const auto steps = static_cast<int>(residual_changes_.size());
  std::array<std::array<double, kAndersonDepth>, kAndersonDepth> gram = {};
  double largest = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j <= i; ++j) {
      gram[i][j] = texels.inner_product(residual_changes_[i], residual_changes_[j]);
    }
    largest = std::max(largest, gram[i][i]);
  }
  if (largest <= 0.0) return;

  // Solve for the coefficients in units of the largest squared step, which floats may not
  // hold in very dark or very bright scenes
  StepProducts products = {};
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j <= i; ++j) {
      const Wide product = to_wide(gram[i][j] / largest);
      products.gram[kAndersonDepth * i + j] = products.gram[kAndersonDepth * j + i] = product;
    }
    products.projection[i] =
        to_wide(texels.inner_product(residual_changes_[i], residual) / largest);
  }
  const vec3 coefficients = step_coefficients(products, steps);
  for (int i = 0; i < steps; ++i) add_scaled(next, -coefficients[i], image_changes_[i], next);
}

}  // namespace lambent
