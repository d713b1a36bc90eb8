// SPDX-License-Identifier: Apache-2.0
// Light seen through surfaces, in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_GLOSSY_SEEN_THROUGH_RECORDS_H
#define LAMBENT_COMPOSE_GLOSSY_SEEN_THROUGH_RECORDS_H

#include "compose/frame_records.h"
#include "compose/gather/shown_gather_records.h"
#include "denoise/denoise_records.h"

LAMBENT_BEGIN

/// For the arrays see SeenThrough; lobes have sharpness 0 where there are none.
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
  Vec3Array long_ways;  ///< Written where long_ways is 1, as below; see SeenThrough.
  FloatArray glass_depths;
  LobeGuideArray lobes;
  FloatArray distances;
  ShownBaseArray bases;  ///< One for each pixel of the band; written where these gather light.
  ShownGatherRecord gather;
  Vec3Array filtered_emitters;
  Vec3Array filtered_coats;
  Vec3Array filtered_long_ways;
  Vec3Array filtered;
};
LAMBENT_DEVICE_ARRAY(SeenThroughArray, SeenThroughRecord, 8)

/// Prepares a band's pixels for a sample of transmitted light.
struct StartThroughArguments {
  SeenThroughArray seen;
  PixelSurfaceArray surfaces;
  uint first;  ///< First pixel of the band among the traced ones.
  uint count;
  uint gathers;  ///< 1: surfaces behind glass gather light, as below.
  uint long_ways;
};

/// Stores the light of the first opaque surfaces behind glass apart, see Glossy::keep_behind.
struct KeepBehindArguments {
  SceneArray scene;
  LitPointArray points;  ///< One a path, as are the next eight arrays.
  PixelSurfaceArray surfaces;
  CoatPathArray paths;
  UintArray pixels;
  Vec3Array diffuse;  ///< Light is added here.
  Vec3Array sky;      ///< What coats reflect of it, and, from `count` on, what clearcoats do; read
                      ///< where `has_sky` is 1.
  Vec3Array drawn;    ///< Light of emitters; read where `draws` is above 0.
  Vec3Array drawn_specular;
  FloatArray drawn_squares;
  CoatRayArray coat_rays;
  SeenThroughArray seen;
  vec3 camera_ws;
  uint first;  ///< First pixel of the band among the traced ones.
  uint count;  ///< Number of paths.
  uint draws;  ///< Samples of emitters a path.
  uint has_sky;
  uint gathers;
};

/// Stores all transmitted light, see keep_through().
struct KeepThroughArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  FloatArray coat_distances;
  Vec4Array fog;        ///< See fog_along(); read where has_fog is 1.
  Vec3Array looked_up;  ///< Irradiance by lookups; read where gathers is 1.
  FloatArray depths;    ///< Of the pixels' surfaces [m], one for each of the traced ones.
  SeenThroughArray seen;
  uint first;
  uint count;
  uint has_fog;
  uint gathers;
  uint long_ways;  ///< 1: light of long ways is stored.
  uint padding;
};

/// Averages the reciprocal distances to what lobes show over neighbouring pixels.
struct SeenDistancesArguments {
  SeenThroughArray seen;
  uint width;  ///< Width of the traced rows [pixels].
  uint height;
};

/// Adds the filtered light of the first opaque surfaces behind glass to all transmitted light.
struct AddBehindArguments {
  SeenThroughArray seen;
  uint count;
  uint draws;  ///< Samples of emitters; 0: none of their light was stored.
  uint gathers;
  uint long_ways;
};

/// Adds filtered transmitted light to the layers.
struct ShowThroughArguments {
  SeenThroughArray seen;
  PixelLayersArray layers;
  uint first;  ///< First of the shown pixels among the traced ones.
  uint count;
  float share;
  uint padding;
};

LAMBENT_END
#endif
