// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin/field_math.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  FieldMathArguments args;
};

vec4 numbers(uint first) {
  return vec4(args.in_numbers.at[first], args.in_numbers.at[first + 1],
              args.in_numbers.at[first + 2], args.in_numbers.at[first + 3]);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= args.count) return;
  uint first = i * kFieldMathInputs;
  FieldMathResult r =
      field_math(numbers(first), numbers(first + 4), numbers(first + 8), numbers(first + 12));
  for (int k = 0; k < kFieldMathOutputs; ++k) {
    args.out_numbers.at[i * kFieldMathOutputs + k] = r.number[k];
  }
}
