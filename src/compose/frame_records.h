// SPDX-License-Identifier: Apache-2.0
// A frame in a device's memory, and the arguments of its kernels.
#ifndef LAMBENT_COMPOSE_FRAME_RECORDS_H
#define LAMBENT_COMPOSE_FRAME_RECORDS_H

#include "field/vulkan/device_records.h"
#include "raytracing/camera_math.h"
#include "raytracing/vulkan/shading_records.h"

LAMBENT_BEGIN

/// The layers of a frame at one pixel; names and units as in RenderedFrame.
struct PixelLayers {
  vec3 all;
  vec3 direct;
  vec3 indirect;
  vec3 irradiance;
  vec3 glossy;
  vec3 emission;
  vec3 albedo;
  vec3 normal;
  vec3 position;
  float depth;
};
LAMBENT_DEVICE_ARRAY(PixelLayersArray, PixelLayers, 4)

/// A ray through each pixel of a band of rows.
struct CameraRaysArguments {
  RayArray rays;
  CameraRecord camera;
  uint width;        ///< Of the picture [pixels].
  uint first_pixel;  ///< Of the band.
  uint count;        ///< Pixels of the band.
  uint index;        ///< Of the sample, of so many:
  uint samples;
  uint seed;
};

/// Where pixels ask the field for light.
struct PixelQueriesArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  QueryArray queries;
  uint count;
  uint mirrored;  ///< 1: on a surface that faces where a mirror would look; 0: on their own.
};

/// Rays that gather the light of pixels, `rays_per_pixel` each, and the index of each pixel's first
/// one.
struct GatherRaysArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  RayArray rays;
  UintArray first_indices;
  uint first;        ///< Of the band's pixels.
  uint count;        ///< From there on.
  uint first_pixel;  ///< Of the band.
  uint rays_per_pixel;
  uint index;  ///< Of the sample.
  uint seed;
};

/// Where rays ask the field for light.
struct RayQueriesArguments {
  LitPointArray points;
  RayArray rays;
  QueryArray queries;
  uint count;
  uint padding;
};

/// Irradiance of pixels from what their rays gathered.
struct GatherSumArguments {
  LitPointArray points;  ///< Of the band's pixels.
  RayArray rays;
  ShadedHitArray shaded;
  Vec3Array direct;  ///< Irradiance of what the rays met, from lights,
  Vec3Array field;   ///< and from the field.
  Vec3Array irradiance;
  uint first;
  uint count;
  uint rays_per_pixel;
  uint padding;
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

/// Adds what pixels show to their layers.
struct ComposeArguments {
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array diffuse;
  Vec3Array specular;
  Vec3Array irradiance;
  Vec3Array mirror_irradiance;
  PixelLayersArray layers;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
  uint first_pixel;  ///< Of the band, among the layers' pixels.
  uint count;
  float share;
  uint has_indirect;  ///< 1: there is indirect light.
  uint looked_up;     ///< 1: it was looked up in the field; see indirect_share().
};

LAMBENT_END
#endif
