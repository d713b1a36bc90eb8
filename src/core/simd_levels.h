// SPDX-License-Identifier: Apache-2.0
// Kernels written in lanes (core/lanes.inl.h), once for each instruction set.
//
// LAMBENT_SIMD_CLONES serves loops that the compiler makes vectors of; operations on vectors that
// are written as such are split to fit the default instruction set before it makes its clones. So
// such a kernel stands in a *.inl.h file of its own, which is included once an instruction set:
//
//     namespace lambent {
//     namespace {
//     #define LAMBENT_KERNELS "..._kernel.inl.h"
//     #include "core/simd_levels.inl.h"
//     }
//
// and LAMBENT_BEST_LEVEL(kernel) is the best that the machine runs. Every operation is elementwise
// and nothing is fused, so all of them compute the same bits.
#pragma once

#include "core/simd.h"

namespace lambent {

/// Floats that are worked on together, whatever the instruction set.
inline constexpr int kLanes = 16;

}  // namespace lambent

#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define LAMBENT_SIMD_LEVELS
#define LAMBENT_BEST_LEVEL(kernel)                         \
  (__builtin_cpu_supports("x86-64-v4")   ? &avx512::kernel \
   : __builtin_cpu_supports("x86-64-v3") ? &avx2::kernel   \
                                         : &baseline::kernel)
#else
#define LAMBENT_BEST_LEVEL(kernel) (&baseline::kernel)
#endif
