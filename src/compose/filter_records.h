// SPDX-License-Identifier: Apache-2.0
// A frame's light that is filtered, in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_FILTER_RECORDS_H
#define LAMBENT_COMPOSE_FILTER_RECORDS_H

#include "compose/frame_records.h"

LAMBENT_BEGIN

/// One sample of the pixels of the traced rows; arrays as in struct FilteredPixels.
struct FilteredPixelsRecord {
  Vec3Array positions_ws;
  Vec3Array normals_ws;
  Vec3Array geometric_normals_ws;
  FloatArray depths;
  Vec3Array gathered;
  FloatArray gathered_variance;
  Vec3Array excess;
  Vec3Array looked_up;
  Vec3Array indirect_albedo;
  UintArray receives;
  Vec3Array emitters;
  FloatArray emitter_variance;
  Vec3Array emitter_albedo;
  FloatArray emitter_levels;
  Vec3Array filtered_gathered;
  Vec3Array filtered_emitters;
};
LAMBENT_DEVICE_ARRAY(FilteredPixelsArray, FilteredPixelsRecord, 8)

/// Keeps a band's sample.
struct KeepPixelsArguments {
  SceneArray scene;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array emitters;          ///< Direct light of emissive surfaces.
  FloatArray emitter_squares;  ///< Sums of squares of what each draw brings, without albedo.
  Vec3Array irradiance;        ///< As it was looked up.
  Vec4Array fog;               ///< As of fog_along, where has_fog is 1.
  FilteredPixelsArray pixels;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint first;        ///< Of the band, among the traced pixels.
  uint count;
  uint draws;     ///< Of emitters, a pixel.
  uint gathered;  ///< 1: indirect light is gathered.
  uint has_fog;
  uint padding;
};

/// Adds filtered light to layers.
struct AddFilteredArguments {
  FilteredPixelsArray pixels;
  PixelLayersArray layers;
  uint first;  ///< Of the shown pixels, among the traced ones.
  uint count;
  float share;
  uint emitters;  ///< 1: there is such light, and so on.
  uint gathered;
  uint padding;
};

LAMBENT_END
#endif
