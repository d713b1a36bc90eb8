// SPDX-License-Identifier: Apache-2.0
// A copy between addresses.
#ifndef LAMBENT_TESTS_TWIN_COPY_WORDS_H
#define LAMBENT_TESTS_TWIN_COPY_WORDS_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

struct CopyWordsArguments {
  UintArray from;
  UintArray to;
  uint count;
  uint padding;
};

LAMBENT_END
#endif
