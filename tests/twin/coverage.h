// SPDX-License-Identifier: Apache-2.0
// Which hits stop their rays.
#ifndef LAMBENT_TESTS_TWIN_COVERAGE_H
#define LAMBENT_TESTS_TWIN_COVERAGE_H

#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

struct CoverageArguments {
  SceneArray scene;
  HitArray hits;
  UintArray stops;
  uint count;
  uint padding;
};

LAMBENT_END
#endif
