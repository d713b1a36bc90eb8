// SPDX-License-Identifier: Apache-2.0
// A copy between addresses.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin/copy_words.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  CopyWordsArguments args;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < args.count) args.to.at[i] = args.from.at[i];
}
