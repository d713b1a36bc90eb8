// SPDX-License-Identifier: Apache-2.0
// The light of a frame that is filtered, in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_FILTER_RECORDS_H
#define LAMBENT_COMPOSE_FILTER_RECORDS_H

#include "compose/frame_records.h"
#include "compose/gather/shown_gather_records.h"
#include "denoise/denoise_records.h"

LAMBENT_BEGIN

/// One sample of the pixels of the traced rows; for the arrays see FilteredPixels.
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
  FloatArray received_weight;
  Vec3Array emitters;
  FloatArray emitter_variance;
  Vec3Array emitter_albedo;
  FloatArray emitter_levels;
  Vec3Array coats;
  Vec3Array coat_excess;
  FloatArray coat_variance;
  Vec3Array coat_albedo;
  LobeGuideArray coat_lobes;  ///< Sharpness 0 where no rays light a coat.
  Vec3Array clearcoats;       ///< Like the coats' arrays, but with normals.
  Vec3Array clearcoat_excess;
  FloatArray clearcoat_variance;
  Vec3Array clearcoat_albedo;
  Vec3Array clearcoat_normals_ws;
  LobeGuideArray clearcoat_lobes;
  Vec3Array mirrored;  ///< Like the coats' arrays, but with the places of mirror images.
  Vec3Array mirrored_albedo;
  Vec3Array mirrored_positions_ws;
  Vec3Array mirrored_normals_ws;
  FloatArray mirrored_depths;
  LobeGuideArray mirrored_lobes;
  Vec3Array mirrored_emitters;  ///< See MirroredBasePixels, as of the next seven.
  FloatArray mirrored_emitter_variance;
  FloatArray mirrored_emitter_levels;
  Vec3Array mirrored_emitter_albedo;
  Vec3Array mirrored_base_positions_ws;
  Vec3Array mirrored_base_normals_ws;
  FloatArray mirrored_base_depths;
  ShownGatherRecord mirrored_gather;
  Vec3Array highlights;
  Vec3Array highlight_albedo;
  LobeGuideArray highlight_lobes;
  Vec3Array filtered_gathered;
  Vec3Array filtered_emitters;
  Vec3Array filtered_coats;
  Vec3Array filtered_clearcoats;
  Vec3Array filtered_mirrored;
  Vec3Array filtered_mirrored_emitters;
  Vec3Array filtered_highlights;
};
LAMBENT_DEVICE_ARRAY(FilteredPixelsArray, FilteredPixelsRecord, 8)

/// Stores a band's sample.
struct KeepPixelsArguments {
  SceneArray scene;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array emitters;  ///< Direct light of emissive surfaces.
  Vec3Array emitter_specular;
  FloatArray emitter_squares;  ///< Sums of squared luminances of the draws, divided by albedo.
  Vec3Array irradiance;        ///< Result of the lookups.
  Vec4Array fog;               ///< See fog_along(); read where kHasFog is set.
  Vec4Array coats;             ///< See CoatLight; read where kHasCoats is set.
  CoatGuideArray coat_guides;  ///< See CoatLight; read where kHasCoats is set.
  FilteredPixelsArray pixels;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint first;        ///< First pixel of the band among the traced pixels.
  uint count;
  uint draws;  ///< Samples of emitters a pixel.
  /// kHasCoats, kHasFog; and kIsFiltered, kCoatsAreFiltered and kClearcoatsAreFiltered where light
  /// of that kind is stored.
  uint has;
};

/// Stores the light that a band's clearcoats reflect from rays, and removes it from `coats`. Runs
/// before keep_pixels.
struct KeepClearcoatsArguments {
  LitPointArray points;        ///< With the clearcoats' normals.
  PixelSurfaceArray surfaces;  ///< With clearcoats in the place of coats.
  Vec4Array coats;             ///< See CoatLight; read where has_rays is 1.
  CoatGuideArray guides;       ///< See CoatLight; read where has_rays is 1.
  FilteredPixelsArray pixels;
  uint first;  ///< First pixel of the band among the traced pixels.
  uint count;
  uint has_rays;
  uint padding;
};

/// Stores the surfaces that pixels' mirrors show, with the light of emitters there; see
/// Glossy::keep_mirrored_bases.
struct KeepMirroredBasesArguments {
  SceneArray scene;
  LitPointArray points;  ///< One a path, as are the next eight arrays.
  PixelSurfaceArray surfaces;
  CoatPathArray paths;
  UintArray pixels;
  Vec3Array diffuse;   ///< Light is added here.
  Vec3Array specular;  ///< Light is added here.
  Vec3Array drawn;     ///< Light of emitters; read where `draws` is above 0, as the next two.
  Vec3Array drawn_specular;
  FloatArray drawn_squares;
  ShownBaseArray bases;
  uint count;    ///< Number of paths.
  uint draws;    ///< Samples of emitters a path.
  uint gathers;  ///< 1: rays gather the surfaces' indirect light.
  uint padding;
};

/// Writes the points at which what a band's pixels show gathers light, with their field queries.
struct ShownPointsArguments {
  PixelSurfaceArray surfaces;  ///< Of the pixels.
  ShownBaseArray bases;
  LitPointArray points;
  PixelSurfaceArray shown_surfaces;  ///< Flags and gi_share alone.
  QueryArray queries;
  UintArray points_found;  ///< One number, to which that of the points is added.
  uint count;              ///< Number of pixels.
  uint padding;
};

/// Stores what the coats that a band's mirrors show reflect, and the light of the surfaces there.
struct KeepMirroredArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  MirroredCoatArray mirrored;
  ShownBaseArray bases;  ///< Read where kKeepsMirroredBases is set.
  Vec3Array looked_up;   ///< Irradiance by lookups; read where kGathersInMirrors is set.
  Vec4Array fog;         ///< See fog_along(); read where has_fog is 1.
  FilteredPixelsArray pixels;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint first;        ///< First pixel of the band among the traced pixels.
  uint count;
  uint has_fog;
  uint keeps;  ///< kKeepsMirroredBases, kGathersInMirrors.
  uint draws;  ///< Samples of emitters on what mirrors show.
  uint padding;
};

/// Adds filtered light to layers.
struct AddFilteredArguments {
  FilteredPixelsArray pixels;
  PixelLayersArray layers;
  uint first;  ///< First of the shown pixels among the traced ones.
  uint count;
  float share;
  uint emitters;  ///< 1: add this kind of light, as for the next six.
  uint gathered;
  uint coats;
  uint clearcoats;
  uint mirrored;
  uint mirrored_emitters;
  uint mirrored_gathered;
  uint padding;
};

LAMBENT_END
#endif
