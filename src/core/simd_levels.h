// SPDX-License-Identifier: Apache-2.0
// Kernels written in lanes (core/lanes.inl.h), once for each instruction set.
//
// LAMBENT_SIMD_CLONES is for loops that the compiler vectorises. Explicit vector operations are
// lowered to the default instruction set before the compiler creates clones. Such kernels are
// therefore in *.inl.h files of their own, which are included once per instruction set:
//
//     namespace lambent {
//     namespace {
//     #define LAMBENT_KERNELS "..._kernel.inl.h"
//     #include "core/simd_levels.inl.h"
//     }
//
// LAMBENT_BEST_LEVEL(kernel) is then the best version that the machine supports. Every operation is
// elementwise and nothing is fused, so all of them compute the same bits.
#pragma once

#include "core/simd.h"

namespace lambent {

/// Floats per vector, for all instruction sets.
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
