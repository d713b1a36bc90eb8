// SPDX-License-Identifier: Apache-2.0
// Which hits stop their rays.
#ifndef LAMBENT_TESTS_TWIN_COVERAGE_H
#define LAMBENT_TESTS_TWIN_COVERAGE_H

#include "raytracing/vulkan/scene_records.h"
#include "scene/coverage.h"

LAMBENT_BEGIN

struct CoverageArguments {
  SceneArray scene;
  HitArray hits;
  UintArray stops;
  uint count;
  uint padding;
};

/// The distance up to which blended surfaces have been passed [m]; hits are up to 10 m away.
const float kPassed = 1.0f;

/// Every other ray carries a pixel's sample.
LAMBENT_FN uint mask_of_ray(uint ray) {
  return ray % 2u == 0u ? 0xFFFFFFFFu : sample_mask(ray / 16u, ray / 2u, 8u, 3u);
}

LAMBENT_END
#endif
