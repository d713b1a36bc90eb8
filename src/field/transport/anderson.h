// SPDX-License-Identifier: Apache-2.0
// Acceleration of a fixed-point iteration x = f(x).
//
// Walker and Ni, "Anderson Acceleration for Fixed-Point Iterations", SIAM J. Numer. Anal. 49(4),
// 2011; for a linear f it is equivalent to GMRES.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "core/large_pages.h"
#include "core/ranks.h"

namespace lambent {

/// Irradiance of probes' interior texels, probe after probe, four floats per texel (the fourth is
/// 0).
using WorkingIrradiance = std::vector<glm::vec4, LargePages<glm::vec4>>;

/// Inner product and norm over all texels. Both give the same bits on any number of threads.
double inner_product(const WorkingIrradiance& a, const WorkingIrradiance& b);
double norm(const WorkingIrradiance& a);

/// The division of texels among ranks, rank after rank.
class SharedTexels {
 public:
  /// All texels belong to this process.
  SharedTexels() = default;
  /// Rank r has the texels from firsts[r] to firsts[r + 1] - 1. `ranks` must outlive this object.
  SharedTexels(Ranks& ranks, std::vector<std::size_t> firsts);

  /// Whether no rank has any texels. `own` is the number of this process's texels.
  bool empty(std::size_t own) const { return firsts_.empty() ? own == 0 : firsts_.back() == 0; }
  /// Inner product and norm over the texels of all ranks, with the same bits as on a single rank.
  /// The arguments are this rank's texels; all ranks must call the function together.
  double inner_product(const WorkingIrradiance& a, const WorkingIrradiance& b) const;
  double norm(const WorkingIrradiance& a) const;

 private:
  Ranks* ranks_ = &one_rank();
  std::vector<std::size_t> firsts_;  // empty: this process is alone
  // The first of each rank's numbers among those that ranks exchange for an inner product
  std::vector<std::size_t> first_numbers_;
};

/// result = a + scale * b
void add_scaled(const WorkingIrradiance& a, float scale, const WorkingIrradiance& b,
                WorkingIrradiance& result);

/// The last steps of an iteration, from which it extrapolates.
class AndersonMemory {
 public:
  /// Adds a step: the changes of the residual f(x) - x and of the image f(x) over it.
  void push(WorkingIrradiance residual_change, WorkingIrradiance image_change);

  /// Moves `next`, the image f(x), to where the linear model of the residual is smallest.
  void extrapolate(const SharedTexels& texels, const WorkingIrradiance& residual,
                   WorkingIrradiance& next) const;

 private:
  std::vector<WorkingIrradiance> residual_changes_, image_changes_;
};

}  // namespace lambent
