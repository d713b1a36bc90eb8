// SPDX-License-Identifier: Apache-2.0
#include "denoise/atrous_cpu.h"

#include "core/simd_levels.h"
#include "shared/packing.h"

namespace lambent {
namespace {

// Used in place of lambent::kLanes: a kernel's values exceed the registers already, and with 16
// floats they would do so twice as much (measured: twice the instructions).
constexpr int kLanes = 8;

#define LAMBENT_KERNELS "denoise/atrous_kernel.inl.h"
#include "core/simd_levels.inl.h"

}  // namespace

void filter_row(const AtrousPass& pass, const AtrousRow& row) {
  static const auto kernel = LAMBENT_BEST_LEVEL(filter_row);
  kernel(pass, row);
}

}  // namespace lambent
