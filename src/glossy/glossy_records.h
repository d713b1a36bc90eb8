// SPDX-License-Identifier: Apache-2.0
// Arguments of the kernels of reflections. Lists hold the paths that have not ended, in any order;
// all other arrays have an entry for each pixel of the rows around a band.
#ifndef LAMBENT_GLOSSY_GLOSSY_RECORDS_H
#define LAMBENT_GLOSSY_GLOSSY_RECORDS_H

#include "field/vulkan/device_records.h"
#include "glossy/path_math.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

/// A list of paths that have not ended: their next rays, their state and their pixels.
struct PathList {
  RayArray rays;
  RayConeArray cones;
  CoatPathArray paths;
  UintArray pixels;  ///< Index among the pixels of the rows around a band.
  UintArray count;   ///< One number: the length of the list.
};

// Bits of CoatReuseArguments::has; CoatRaysArguments::keeps has those of mirrors.
const uint kReflectsSky = 1u;          ///< `sky` is added.
const uint kFindsGuides = 2u;          ///< `guides` are written.
const uint kKeepsMirrored = 4u;        ///< `mirrored` is brought up to date.
const uint kKeepsOwn = 8u;             ///< `own` is written.
const uint kOrthographic = 16u;        ///< The camera is orthographic.
const uint kKeepsMirroredBases = 32u;  ///< A ShownBase is stored of each pixel.
const uint kGathersInMirrors = 64u;    ///< These gather their light.

/// Draws the specular rays of pixels.
struct CoatRaysArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  PathList list;   ///< Rays are appended here.
  uint count;      ///< Number of pixels.
  uint first_row;  ///< First row, counted in the picture.
  uint width;      ///< Width of the picture [pixels].
  uint rows;       ///< Every `rows`-th row has rays.
  uint sample_index;
  uint seed;
  uint emitter_samples;           ///< Samples of the pixels' own direct light.
  uint keeps;                     ///< kKeepsMirrored, kKeepsMirroredBases: of what mirrors show.
  MirroredCoatArray mirrored;     ///< Written where kKeepsMirrored is set.
  ShownBaseArray mirrored_bases;  ///< Written where kKeepsMirroredBases is set.
  OwnRayLightArray own;           ///< Read where `ray` is not 0.
  uint ray;  ///< Number of the rays; from 1 on, only pixels with needs_further_rays() have one.
  uint padding;
};

/// Draws the rays that pixels send through their surfaces.
struct ThroughRaysArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  PathList list;              ///< Rays are appended here.
  FloatArray coat_distances;  ///< See TransmittedLight; one a pixel.
  uint count;                 ///< Number of pixels.
  uint first_index;           ///< Index of the first pixel in the picture.
  uint salt;
  uint seed;
  uint emitter_samples;  ///< Of the light behind surfaces.
  uint sample_index;
};

/// Shades hits of the sky and of emitters, and writes two field queries for each path.
struct CoatHitsArguments {
  SceneArray scene;
  HitArray hits;  ///< One a path, as are the next five arrays (queries: two a path).
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatPathArray paths;
  UintArray pixels;
  QueryArray queries;
  CoatRayArray coat_rays;
  FloatArray coat_distances;   ///< For paths that gather the light of coats behind glass.
  MirroredCoatArray mirrored;  ///< For paths from mirrors.
  uint count;                  ///< Number of paths.
  uint bounce;
  uint first_index;  ///< Index of the first pixel in the picture.
  uint has_field;    ///< 1: there is a field to look up.
};

/// Adds the light that hits reflect, and appends the paths that go on.
struct CoatLightArguments {
  LitPointArray points;  ///< One a path, as are the next six arrays (field: two a path).
  PixelSurfaceArray surfaces;
  Vec3Array diffuse;
  Vec3Array specular;
  Vec3Array field;  ///< Results of the field queries.
  CoatPathArray paths;
  UintArray pixels;
  PathList next;  ///< Paths that go on are appended here.
  CoatRayArray coat_rays;
  uint count;
  uint first_index;
  uint salt;
  uint seed;
  uint path_step;        ///< See pack_path_step().
  uint emitter_samples;  ///< Of the direct light of hits.
};

/// Lists one of the branches of each path that splits at glass.
struct SplitPathsArguments {
  LitPointArray points;  ///< One a path, as are the next three arrays.
  PixelSurfaceArray surfaces;
  CoatPathArray paths;
  UintArray pixels;
  PathList branches;  ///< Has a place for each path that has split.
  uint count;
  uint first_index;
  uint salt;
  uint seed;
  uint path_step;        ///< See pack_path_step().
  uint emitter_samples;  ///< Of the direct light of hits.
};

/// Adds the light behind rough surfaces to the light of the pixels' rays.
struct AddBehindLightArguments {
  PixelSurfaceArray surfaces;  ///< One a path, or a pixel, as is the light.
  Vec3Array light;             ///< Read where lights behind the surface are sampled.
  CoatPathArray paths;         ///< Read where has_paths is 1, also the pixels.
  UintArray pixels;
  CoatRayArray coat_rays;
  uint count;
  uint has_paths;  ///< 0: the surfaces are those of the pixels.
};

/// Replaces each surface's reflectance by that of its clearcoat alone.
struct ShowClearcoatsArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  uint count;
  uint padding;
};

/// Adds the clearcoats' light to the band's pixels, whose surfaces ShowClearcoatsArguments changed.
struct ClearcoatLightArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec4Array coats;  ///< Result of Glossy::reflect; read where has_rays is 1.
  Vec3Array mirror_irradiance;
  Vec3Array light;  ///< Light is added here.
  uint count;
  uint has_rays;
};

/// Computes the light that the band's pixels reflect from the rays around them.
struct CoatReuseArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  Vec4Array light;        ///< See CoatLight; one a pixel of the band.
  CoatGuideArray guides;  ///< See CoatLight; one a pixel of the band.
  MirroredCoatArray mirrored;
  OwnRayLightArray own;  ///< One a pixel of the band.
  Vec3Array sky;         ///< See reflect_band(); one a pixel of the band.
  vec3 camera_ws;
  vec3 camera_back;   ///< Unit; against the direction of view.
  float pixel_width;  ///< [m], at a distance of one metre; orthographic cameras: everywhere.
  uint first_row;     ///< First of the rows around the band, counted in the picture.
  uint band_row;      ///< First row of the band, counted in the picture.
  uint count;         ///< Number of pixels in the band.
  uint width;         ///< Width of the picture [pixels].
  uint height;
  uint rows;
  uint sample_index;
  uint has;              ///< kReflectsSky, ...
  uint emitter_samples;  ///< Samples of the pixels' own direct light.
};

/// Adds what further rays found to the light of pixels.
struct FurtherRaysArguments {
  LitPointArray points;  ///< One a pixel of the band, as are the next four.
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  OwnRayLightArray own;
  Vec4Array light;  ///< See CoatLight.
  uint count;
  uint rays;             ///< With the first one.
  uint emitter_samples;  ///< Samples of the pixels' own direct light.
  uint padding;
};

LAMBENT_END
#endif
