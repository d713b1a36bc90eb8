// SPDX-License-Identifier: Apache-2.0
// A frame in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_FRAME_RECORDS_H
#define LAMBENT_COMPOSE_FRAME_RECORDS_H

#include "field/vulkan/device_records.h"
#include "glossy/glossy_math.h"
#include "raytracing/ray_cone.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

/// The layers of a frame at one pixel; names and units as in RenderedFrame.
struct PixelLayers {
  vec3 all;
  vec3 direct;
  vec3 indirect;
  vec3 irradiance;
  vec3 glossy;
  vec3 transmission;
  vec3 emission;
  vec3 fog;
  vec3 albedo;
  vec3 normal;
  vec3 position;
  float depth;
};
LAMBENT_DEVICE_ARRAY(PixelLayersArray, PixelLayers, 4)

/// A ray through each pixel of a band of rows.
struct CameraRaysArguments {
  RayArray rays;
  RayConeArray cones;
  CameraRecord camera;
  uint width;        ///< Of the picture [pixels].
  uint first_pixel;  ///< Of the band.
  uint count;        ///< Pixels of the band.
  uint index;        ///< Of the sample, of so many:
  uint samples;
  uint seed;
  uint jitter;  ///< As of subpixel_position.
  uint padding;
};

/// Where pixels ask the field for light.
struct PixelQueriesArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  QueryArray queries;
  uint count;
  uint mirrored;  ///< 1: on a surface that faces where a mirror would look; 0: on their own.
};

/// What pixels show, as passes over views read it.
struct ViewGeometryArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array positions_ws;  ///< [m]; 0 where nothing is seen, as normals are.
  Vec3Array normals_ws;
  FloatArray depths;  ///< [m]; 0 where nothing is seen in front of the camera.
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint count;
  uint padding;
};

/// Takes what another source brings out of the field's light, and adds that source's own.
struct ReplaceLightArguments {
  Vec3Array irradiance;
  Vec3Array subtracted_field;
  Vec3Array added;
  uint count;
  uint subtracts;  ///< 1: there is something to take out.
};

// ComposeArguments::has
const uint kHasCoats = 1u;            ///< Rays bring light of coats,
const uint kHasTransmission = 2u;     ///< and through surfaces.
const uint kHasFog = 4u;              ///< Pixels are seen through fog.
const uint kHasIndirect = 8u;         ///< There is indirect light,
const uint kIsLookedUp = 16u;         ///< which was looked up in the field; see indirect_share(),
const uint kIsFiltered = 32u;         ///< and is added once it was filtered.
const uint kHasClearcoats = 64u;      ///< Light of clearcoats is part of `specular`.
const uint kCoatsAreFiltered = 128u;  ///< Light of coats by rays is added once it was filtered.
const uint kClearcoatsAreFiltered = 256u;  ///< That of clearcoats, of KeepPixelsArguments::has.

/// Adds what pixels show to their layers.
struct ComposeArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array diffuse;
  Vec3Array specular;
  Vec3Array irradiance;
  Vec3Array mirror_irradiance;
  Vec4Array coats;           ///< As in coat_light(), where there are any.
  CoatRayArray transmitted;  ///< Light that comes through surfaces, where there is any.
  Vec4Array fog;             ///< As of fog_along, where there is any.
  PixelLayersArray layers;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint first_pixel;  ///< Of those that are shown, among the layers' pixels.
  uint count;
  float share;
  uint first;  ///< Of the band's pixels, the first that is shown.
  uint has;    ///< kHasCoats, ...
  uint padding;
};

LAMBENT_END
#endif
