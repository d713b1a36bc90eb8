// SPDX-License-Identifier: Apache-2.0
// Light that is filtered, in a device's memory, and the arguments of the kernels.
#ifndef LAMBENT_DENOISE_DENOISE_RECORDS_H
#define LAMBENT_DENOISE_DENOISE_RECORDS_H

#include "denoise/atrous_pass.h"
#include "raytracing/vulkan/scene_records.h"

LAMBENT_BEGIN

/// Light of a pixel between passes; for the members see AtrousLight.
struct DenoiseRecord {
  vec3 light;
  float spread;
  vec3 base;
  float share;
};
LAMBENT_DEVICE_ARRAY(DenoiseArray, DenoiseRecord, 4)

LAMBENT_DEVICE_ARRAY(LobeGuideArray, LobeGuide, 4)

/// Converts sampled light, or a part of it, to the passes' format.
struct DenoiseStartArguments {
  Vec3Array light;
  Vec3Array base;       ///< Read where `has_base` is 1.
  FloatArray variance;  ///< Variance of its luminance; read where `measured` is 1.
  DenoiseArray out_light;
  uint width;  ///< Pixels in a row.
  uint count;
  uint has_base;
  uint measured;
  uint part;  ///< kWholeLight, kWithoutFireflies or kFirefliesAlone.
  uint padding;
};

/// Runs a pass over a picture.
struct DenoisePassArguments {
  Vec3Array positions_ws;
  Vec3Array normals_ws;
  FloatArray depths;
  FloatArray levels;     ///< Read where `by.has_levels` is 1.
  LobeGuideArray lobes;  ///< Read where `by.has_lobes` is 1.
  DenoiseArray in_light;
  DenoiseArray out_light;
  AtrousPass by;
  uint width;
  uint height;
  uint padding;
};

/// Converts the last pass's result to filtered light, with the detail of its base.
struct DenoiseFinishArguments {
  DenoiseArray in_light;
  Vec3Array base;
  Vec3Array filtered;
  uint count;
  uint has_base;
  uint adds;  ///< 1: adds to the contents of `filtered`.
  uint padding;
};

LAMBENT_END
#endif
