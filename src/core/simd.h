// SPDX-License-Identifier: Apache-2.0
#pragma once

// A kernel's parts: inlined, so that they are compiled for its instruction set.
#define LAMBENT_FORCE_INLINE __attribute__((always_inline)) inline

// Compiles a kernel for several x86-64 levels; the best one is selected when the program starts.
// Its loops are elementwise, so every version computes the same bits (products and sums are never
// fused, see LambentTarget.cmake). Not under sanitizers: they would instrument the selection, which
// runs before they are initialised.
#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define LAMBENT_SIMD_CLONES __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define LAMBENT_SIMD_CLONES
#endif
