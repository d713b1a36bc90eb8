// SPDX-License-Identifier: Apache-2.0
// Acceleration of a fixed-point iteration x = f(x).
//
// Walker and Ni, "Anderson Acceleration for Fixed-Point Iterations", SIAM J. Numer. Anal. 49(4),
// 2011; for a linear f it is equivalent to GMRES.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/large_pages.h"

namespace lambent {

/// Irradiance of probes' interior texels, probe after probe, four floats a texel (the fourth is 0).
using WorkingIrradiance = std::vector<glm::vec4, LargePages<glm::vec4>>;

/// Inner product and norm over all texels. Both give the same bits on any number of threads.
double inner_product(const WorkingIrradiance& a, const WorkingIrradiance& b);
double norm(const WorkingIrradiance& a);

/// result = a + scale * b
void add_scaled(const WorkingIrradiance& a, float scale, const WorkingIrradiance& b,
                WorkingIrradiance& result);

/// The last steps of an iteration, from which it extrapolates.
class AndersonMemory {
 public:
  /// Adds a step: the changes of the residual f(x) - x and of the image f(x) over it.
  void push(WorkingIrradiance residual_change, WorkingIrradiance image_change);

  /// Moves `next`, the image f(x), to where the linear model of the residual is smallest.
  void extrapolate(const WorkingIrradiance& residual, WorkingIrradiance& next) const;

 private:
  std::vector<WorkingIrradiance> residual_changes_, image_changes_;
};

}  // namespace lambent
