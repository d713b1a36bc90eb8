// SPDX-License-Identifier: Apache-2.0
// A frame in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_FRAME_RECORDS_H
#define LAMBENT_COMPOSE_FRAME_RECORDS_H

#include "field/vulkan/device_records.h"
#include "glossy/glossy_math.h"
#include "raytracing/ray_cone.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

/// The layers of a frame at one pixel; for names and units see RenderedFrame.
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

/// All layers times `scale`.
LAMBENT_FN PixelLayers scaled_layers(PixelLayers layers, float scale) {
  PixelLayers scaled = {
      scale * layers.all,        scale * layers.direct,   scale * layers.indirect,
      scale * layers.irradiance, scale * layers.glossy,   scale * layers.transmission,
      scale * layers.emission,   scale * layers.fog,      scale * layers.albedo,
      scale * layers.normal,     scale * layers.position, scale * layers.depth};
  return scaled;
}

/// Makes a ray through each pixel of a band of rows.
struct CameraRaysArguments {
  RayArray rays;
  RayConeArray cones;
  CameraRecord camera;
  uint width;        ///< Width of the picture [pixels].
  uint first_pixel;  ///< First pixel of the band.
  uint count;        ///< Number of pixels in the band.
  uint index;        ///< Index of the sample, below `samples`.
  uint samples;
  uint seed;
  uint jitter;        ///< See subpixel_position().
  uint round_first;   ///< See SampleRound.
  UintArray skipped;  ///< Of the picture's pixels, see SampleRound; read where `round_first` > 0.
};

/// Writes the pixels' field queries.
struct PixelQueriesArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  QueryArray queries;
  uint count;
  uint mirrored;  ///< 1: queries face coat_direction(); 0: the shading normal.
};

/// Writes the geometry that pixels show, for passes over views.
struct ViewGeometryArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array positions_ws;  ///< [m]; positions and normals are 0 where nothing is seen.
  Vec3Array normals_ws;
  FloatArray depths;  ///< [m]; 0 where nothing is seen in front of the camera.
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint count;
  uint padding;
};

// Bits of ComposeArguments::has
const uint kHasCoats = 1u;            ///< Coats have light from rays.
const uint kHasTransmission = 2u;     ///< Surfaces transmit light.
const uint kHasFog = 4u;              ///< Pixels are seen through fog.
const uint kHasIndirect = 8u;         ///< There is indirect light.
const uint kIsLookedUp = 16u;         ///< Indirect light was looked up; see indirect_share().
const uint kIsFiltered = 32u;         ///< Indirect light is added once it was filtered.
const uint kHasClearcoats = 64u;      ///< Light of clearcoats is part of `specular`.
const uint kCoatsAreFiltered = 128u;  ///< Light of coats from rays is added once it was filtered.
/// Light of clearcoats is added once it was filtered; only in KeepPixelsArguments::has.
const uint kClearcoatsAreFiltered = 256u;

/// Adds a sample of the pixels to their layers.
struct ComposeArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array diffuse;
  Vec3Array specular;
  Vec3Array irradiance;
  Vec3Array mirror_irradiance;
  Vec4Array coats;           ///< Argument `by_rays` of coat_light(); read where kHasCoats is set.
  CoatRayArray transmitted;  ///< Transmitted light; read where kHasTransmission is set.
  Vec4Array fog;             ///< See fog_along(); read where kHasFog is set.
  PixelLayersArray layers;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint first_pixel;  ///< First of the shown pixels among the layers' pixels.
  uint count;
  float share;
  uint first;  ///< First of the shown pixels among the band's.
  uint has;    ///< kHasCoats, ...
  uint padding;
};

/// Computes the luminances of a picture's pixels.
struct LuminancesArguments {
  PixelLayersArray layers;
  FloatArray luminances;
  uint count;
  uint padding;
};

/// Multiplies the layers of a picture's pixels, but for skipped ones, see SampleRound.
struct ScaleLayersArguments {
  PixelLayersArray layers;
  UintArray skipped;
  uint count;
  float scale;
};

LAMBENT_END
#endif
