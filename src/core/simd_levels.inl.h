// SPDX-License-Identifier: Apache-2.0
// Includes the file LAMBENT_KERNELS once per instruction set: see core/simd_levels.h. Without an
// include guard; included inside a namespace.

namespace baseline {
#include LAMBENT_KERNELS
}  // namespace baseline
#ifdef LAMBENT_SIMD_LEVELS
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v3")
namespace avx2 {
#include LAMBENT_KERNELS
}  // namespace avx2
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
namespace avx512 {
#include LAMBENT_KERNELS
}  // namespace avx512
#pragma GCC pop_options
#endif
