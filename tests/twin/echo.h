// SPDX-License-Identifier: Apache-2.0
// A struct of every kind of member that shared structs have.
#ifndef LAMBENT_TESTS_TWIN_ECHO_H
#define LAMBENT_TESTS_TWIN_ECHO_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

struct EchoRecord {
  float a;
  vec3 b;
  uint c;
  vec2 d;
  int e;
  mat3 f;
  vec4 g;
};
LAMBENT_DEVICE_ARRAY(EchoArray, EchoRecord, 4)

struct EchoArguments {
  EchoArray records;
  FloatArray members;  ///< Of each record 20, times the scale.
  uint count;
  float scale;
};

LAMBENT_END
#endif
