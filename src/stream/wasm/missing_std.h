// SPDX-License-Identifier: Apache-2.0
// Parts of C++20 that the standard library of emscripten 3.1 lacks. Included before everything
// else.
#pragma once

#include <version>

#ifndef __cpp_lib_bit_cast
#include <bit>

namespace std {  // NOLINT(cert-dcl58-cpp): it is std::bit_cast that is missing

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  return __builtin_bit_cast(To, from);
}

}  // namespace std
#endif
