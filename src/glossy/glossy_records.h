// SPDX-License-Identifier: Apache-2.0
// Arguments of the kernels of reflections. Ways of rays that have not ended lie one after the other
// in lists, in any order; everything else has an entry for each pixel of the rows around a band.
#ifndef LAMBENT_GLOSSY_GLOSSY_RECORDS_H
#define LAMBENT_GLOSSY_GLOSSY_RECORDS_H

#include "field/vulkan/device_records.h"
#include "glossy/way_math.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

/// A list of ways that have not ended: what their next rays are, and whose they are.
struct WayList {
  RayArray rays;
  RayConeArray cones;
  CoatPathArray paths;
  UintArray pixels;  ///< Of the rows around a band.
  UintArray count;   ///< One number: how many ways there are.
};

/// Draws the pixels' rays.
struct CoatRaysArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  WayList ways;    ///< Which rays are appended to.
  uint count;      ///< Pixels.
  uint first_row;  ///< In the picture.
  uint width;      ///< Of the picture [pixels].
  uint rows;       ///< Every so manieth has rays.
  uint sample_index;
  uint seed;
};

/// Draws the rays that pixels send through their surfaces.
struct ThroughRaysArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  WayList ways;               ///< Which rays are appended to.
  FloatArray coat_distances;  ///< As in struct TransmittedLight, a pixel each.
  uint count;                 ///< Pixels.
  uint first_index;           ///< Of the first one among those of the picture.
  uint salt;
  uint seed;
};

/// What rays met becomes what shading reads, and questions to the field: two a way.
struct CoatHitsArguments {
  HitArray hits;  ///< A list, as are:
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatPathArray paths;
  UintArray pixels;
  QueryArray queries;
  CoatRayArray coat_rays;
  FloatArray coat_distances;  ///< Of ways that bring light of coats behind glass.
  uint count;                 ///< Ways.
  uint bounce;
  uint emitter_samples;  ///< Of the direct light of what they meet.
  uint first_index;      ///< Of the first pixel among those of the picture.
  uint has_field;        ///< 1: there is a field to be asked.
  uint padding;
};

/// Adds the light of what rays met, and lets ways go on.
struct CoatLightArguments {
  LitPointArray points;  ///< Lists:
  PixelSurfaceArray surfaces;
  Vec3Array diffuse;
  Vec3Array specular;
  Vec3Array field;  ///< Answers, two a way.
  CoatPathArray paths;
  UintArray pixels;
  WayList next;  ///< Ways that go on are appended here.
  CoatRayArray coat_rays;
  uint count;
  uint first_index;
  uint salt;
  uint seed;
  uint bounce;
  uint padding;
};

/// Keeps the branches that are reflected where ways fork.
struct ForkWaysArguments {
  LitPointArray points;  ///< Lists:
  PixelSurfaceArray surfaces;
  CoatPathArray paths;
  UintArray pixels;
  WayList reflected;  ///< Branches are appended here.
  uint count;
  uint first_index;
  uint salt;
  uint seed;
  uint bounce;
  uint padding;
};

/// Makes clearcoats coats.
struct ShowClearcoatsArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  uint count;
  uint padding;
};

/// Light of clearcoats of the band's pixels, which such surfaces have.
struct ClearcoatLightArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec4Array coats;  ///< As of Glossy::reflect; read where has_rays is 1.
  Vec3Array mirror_irradiance;
  Vec3Array light;  ///< Is added to.
  uint count;
  uint has_rays;
};

/// Has the band's pixels reflect the rays around them.
struct CoatReuseArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  CoatRayArray coat_rays;
  Vec4Array light;               ///< As in struct CoatLight, a pixel of the band each.
  FloatArray inverse_distances;  ///< As there; written where `finds_distances` is 1.
  vec3 camera_ws;
  vec3 camera_back;   ///< Unit; against the direction of view.
  float pixel_width;  ///< At a distance of one metre; of an orthographic camera everywhere.
  uint orthographic;
  uint first_row;  ///< Of the rows around the band.
  uint band_row;   ///< The band's first.
  uint count;      ///< Pixels of the band.
  uint width;      ///< Of the picture [pixels].
  uint height;
  uint rows;
  uint sample_index;
  uint emitter_samples;
  uint finds_distances;
  uint padding;
};

LAMBENT_END
#endif
