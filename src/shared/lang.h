// SPDX-License-Identifier: Apache-2.0
// The common subset of C++20 and GLSL 4.6. No other shared file tests for the language that it is
// compiled as.
//
// Every other header in this folder, and every technique's shared mathematics, is valid in both
// languages: float literals carry an f, vectors have no swizzles, structs have no defaults.
#ifndef LAMBENT_SHARED_LANG_H
#define LAMBENT_SHARED_LANG_H

#ifdef __cplusplus

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/packing.hpp>

#define LAMBENT_BEGIN namespace lambent {
#define LAMBENT_END }
#define LAMBENT_FN inline
#define LAMBENT_INOUT(T) T&
#define LAMBENT_OUT(T) T&
/// Qualifies a float whose operations must each round as written.
#define LAMBENT_PRECISE const
/// Before a loop that devices should unroll.
#define LAMBENT_UNROLL

/// An array in a device's memory, as shaders reach it: `Name` holds its address in C++, and in GLSL
/// is a reference whose member `at` is the array. Its address is a multiple of `alignment`.
#define LAMBENT_DEVICE_ARRAY(Name, T, alignment)      \
  struct Name {                                       \
    static constexpr unsigned kAlignment = alignment; \
    std::uint64_t address = 0;                        \
  };

namespace lambent {
using glm::ivec2;
using glm::ivec3;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;

inline int clamp(int x, int low, int high) {
  return x < low ? low : (x > high ? high : x);
}
using glm::bitfieldReverse;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::findMSB;
using glm::floatBitsToInt;
using glm::floatBitsToUint;
using glm::fract;
using glm::intBitsToFloat;
using glm::inversesqrt;
using glm::length;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::reflect;
using glm::sign;
using glm::step;
using glm::uintBitsToFloat;
using std::abs;
using std::acos;
using std::atan;
using std::cos;
using std::exp;
using std::exp2;
using std::floor;
using std::log2;
using std::pow;
using std::sin;
using std::sqrt;
inline float atan(float y, float x) {
  return std::atan2(y, x);
}
inline vec3 abs(const vec3& v) {
  return glm::abs(v);
}
inline vec2 abs(const vec2& v) {
  return glm::abs(v);
}
inline vec3 floor(const vec3& v) {
  return glm::floor(v);
}
inline vec2 floor(const vec2& v) {
  return glm::floor(v);
}
inline vec3 sqrt(const vec3& v) {
  return glm::sqrt(v);
}
inline vec3 pow(const vec3& v, const vec3& e) {
  return glm::pow(v, e);
}
}  // namespace lambent

#else

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_control_flow_attributes : require

#define LAMBENT_DEVICE_ARRAY(Name, T, alignment)                                     \
  layout(buffer_reference, scalar, buffer_reference_align = alignment) buffer Name { \
    T at[];                                                                          \
  };

#define LAMBENT_BEGIN
#define LAMBENT_END
#define LAMBENT_FN
#define LAMBENT_INOUT(T) inout T
#define LAMBENT_OUT(T) out T
#define LAMBENT_PRECISE precise const
#define LAMBENT_UNROLL [[unroll]]

#endif

LAMBENT_BEGIN

LAMBENT_FN float infinity() {
  return uintBitsToFloat(0x7F800000u);
}

// In place of ?: in formulas that are also compiled for lanes, each of which has a condition of its
// own. Both values are computed; the one that is not selected may be infinite or not a number.
LAMBENT_FN float select(bool condition, float yes, float no) {
  return condition ? yes : no;
}
LAMBENT_FN vec3 select(bool condition, vec3 yes, vec3 no) {
  return condition ? yes : no;
}

LAMBENT_END
#endif
