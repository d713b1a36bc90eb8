// SPDX-License-Identifier: Apache-2.0
// A frame's light that is filtered, in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_FILTER_RECORDS_H
#define LAMBENT_COMPOSE_FILTER_RECORDS_H

#include "compose/frame_records.h"
#include "denoise/denoise_records.h"

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
  Vec3Array coats;
  Vec3Array coat_albedo;
  LobeGuideArray coat_lobes;  ///< Of sharpness 0 where no rays light a coat.
  Vec3Array clearcoats;       ///< Of clearcoats that are filtered, and so on.
  Vec3Array clearcoat_albedo;
  Vec3Array clearcoat_normals_ws;
  LobeGuideArray clearcoat_lobes;
  Vec3Array highlights;
  Vec3Array highlight_albedo;
  LobeGuideArray highlight_lobes;
  Vec3Array filtered_gathered;
  Vec3Array filtered_emitters;
  Vec3Array filtered_coats;
  Vec3Array filtered_clearcoats;
  Vec3Array filtered_highlights;
};
LAMBENT_DEVICE_ARRAY(FilteredPixelsArray, FilteredPixelsRecord, 8)

/// Keeps a band's sample.
struct KeepPixelsArguments {
  SceneArray scene;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array emitters;  ///< Direct light of emissive surfaces.
  Vec3Array emitter_specular;
  FloatArray emitter_squares;  ///< Sums of squares of what each draw brings, without albedo.
  Vec3Array irradiance;        ///< As it was looked up.
  Vec4Array fog;               ///< As of fog_along, where there is any.
  Vec4Array coats;             ///< As in struct CoatLight, where there are any.
  FloatArray coat_inverse_distances;
  FilteredPixelsArray pixels;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint first;        ///< Of the band, among the traced pixels.
  uint count;
  uint draws;  ///< Of emitters, a pixel.
  /// kHasCoats, kHasFog; kIsFiltered, kCoatsAreFiltered and kClearcoatsAreFiltered where such light
  /// is kept.
  uint has;
};

/// Keeps what a band's clearcoats reflect by rays, before keep_pixels, and takes it out of `coats`.
struct KeepClearcoatsArguments {
  LitPointArray points;        ///< As clearcoats have them,
  PixelSurfaceArray surfaces;  ///< these as coats.
  Vec4Array coats;             ///< As in struct CoatLight; read where has_rays is 1,
  FloatArray inverse_distances;
  FilteredPixelsArray pixels;
  uint first;  ///< Of the band, among the traced pixels.
  uint count;
  uint has_rays;
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
  uint coats;
  uint clearcoats;
  uint padding;
};

LAMBENT_END
#endif
