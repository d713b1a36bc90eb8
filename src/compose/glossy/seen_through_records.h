// SPDX-License-Identifier: Apache-2.0
// What pixels see through their surfaces, in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_GLOSSY_SEEN_THROUGH_RECORDS_H
#define LAMBENT_COMPOSE_GLOSSY_SEEN_THROUGH_RECORDS_H

#include "compose/frame_records.h"
#include "denoise/denoise_records.h"

LAMBENT_BEGIN

/// Arrays as in struct SeenThrough; lobes are of sharpness 0 where there are none.
struct SeenThroughRecord {
  FloatArray depths;
  Vec3Array positions_ws;
  Vec3Array normals_ws;
  Vec3Array emitters;
  FloatArray emitter_variance;
  FloatArray emitter_levels;
  Vec3Array emitter_albedo;
  Vec3Array coats;
  Vec3Array coat_albedo;
  LobeGuideArray coat_lobes;
  FloatArray coat_distances;
  Vec3Array light;
  Vec3Array albedo;
  LobeGuideArray lobes;
  FloatArray distances;
  Vec3Array filtered_emitters;
  Vec3Array filtered_coats;
  Vec3Array filtered;
};
LAMBENT_DEVICE_ARRAY(SeenThroughArray, SeenThroughRecord, 8)

/// Has pixels see nothing through their surfaces.
struct StartThroughArguments {
  SeenThroughArray seen;
  uint first;  ///< Of the band, among the traced pixels.
  uint count;
};

/// Keeps apart what lights up the first surfaces behind glass, as Glossy::keep_behind.
struct KeepBehindArguments {
  SceneArray scene;
  LitPointArray points;  ///< Lists of ways, as are:
  PixelSurfaceArray surfaces;
  CoatPathArray paths;
  UintArray pixels;
  Vec3Array diffuse;  ///< Is added to.
  Vec3Array drawn;    ///< Light of emitters; read where there are draws.
  Vec3Array drawn_specular;
  FloatArray drawn_squares;
  CoatRayArray coat_rays;
  SeenThroughArray seen;
  vec3 camera_ws;
  uint first;  ///< Of the band, among the traced pixels.
  uint count;  ///< Ways.
  uint draws;  ///< Of emitters, a way.
};

/// Keeps all light that comes through, as keep_through().
struct KeepThroughArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  FloatArray coat_distances;
  Vec4Array fog;  ///< As of fog_along; read where has_fog is 1.
  SeenThroughArray seen;
  uint first;
  uint count;
  uint has_fog;
  uint padding;
};

/// Finds how far away what lobes see is, as means over pixels.
struct SeenDistancesArguments {
  SeenThroughArray seen;
  uint width;  ///< Of the traced rows [pixels].
  uint height;
};

/// Adds filtered light of the first surfaces behind glass to all light.
struct AddBehindArguments {
  SeenThroughArray seen;
  uint count;
  uint draws;  ///< Of emitters; 0: none of their light was kept.
};

/// Adds filtered light to the layers.
struct ShowThroughArguments {
  SeenThroughArray seen;
  PixelLayersArray layers;
  uint first;  ///< Of the shown pixels, among the traced ones.
  uint count;
  float share;
  uint padding;
};

LAMBENT_END
#endif
