// SPDX-License-Identifier: Apache-2.0
// What the passes of a gather take on a device. Pictures are arrays, rows from the top; mosaics lie
// as mosaic_index (rsm/deinterleave.h) tells.
#ifndef LAMBENT_RSM_VULKAN_DEVICE_PASSES_H
#define LAMBENT_RSM_VULKAN_DEVICE_PASSES_H

#include "raytracing/ray_records.h"
#include "rsm/maps/projection.h"
#include "rsm/pattern.h"
#include "rsm/records.h"

LAMBENT_BEGIN

/// What the camera sees, as struct RsmView of lambent/rsm.h.
struct DeviceView {
  Vec3Array positions_ws;
  Vec3Array normals_ws;
  FloatArray depths;
};

/// The same restructured, as blurs read it: 20 bytes a pixel.
struct DeviceGuide {
  Vec4Array points;   ///< Position [m], one over depth [1/m]; 0: nothing is seen.
  UintArray normals;  ///< encode_unit_vector.
};

/// Where the light of a gather goes.
struct GatherTarget {
  DeviceGuide guide;  ///< Filled where light is blurred.
  /// Where light is blurred: three planes of pack_upper_halves, irradiance and R of
  /// shared/reorient_irradiance.h, red and x, green and y, blue and z.
  UintArray light;
  Vec3Array picture;   ///< Where it is not: irradiance [W/m^2].
  FloatArray arrived;  ///< With kGatherDimmed: share of the light that arrives, a pixel.
};

const uint kGatherBlurred = 1u;  ///< Light will be blurred.
const uint kGatherDimmed = 2u;
/// Texels are asked where they were rendered: `places` tells where.
const uint kGatherRendered = 4u;

/// Pixels of an invocation of rsm_gather, a tile's height apart: a texel that was read from the
/// workgroup's memory, which takes as long as its arithmetic, serves all of them.
const int kGatherPixels = 2;

struct RsmGatherArguments {
  DeviceView view;
  GatherTarget target;
  RsmTexelArray texels;
  UintArray places;
  int width;
  int height;
  int sub_maps;
  int count;  ///< Texels a sub-map.
  uint flags;
  uint unused;
};

/// A map whose texels a disk samples.
struct DiskMap {
  RsmTexelArray texels;
  DiskSampleArray samples;  ///< For the sub-maps in turn: `count` of each.
  MapProjection projection;
  int resolution;
};
LAMBENT_DEVICE_ARRAY(DiskMapArray, DiskMap, 8)

struct DiskArguments {
  DeviceView view;
  GatherTarget target;
  DiskMapArray maps;
  int map_count;
  int width;
  int height;
  int sub_maps;
  int count;  ///< Samples a sub-map.
  uint flags;
  float softening;
  uint unused;
};

/// Rays of pixels to texels of their sub-maps. They lie workgroup after workgroup, invocation after
/// invocation, `rays_per_pixel` of each; those of pixels that gather nothing are not traced.
struct VisibilityArguments {
  DeviceView view;
  RsmTexelArray texels;
  RayArray rays;
  UintArray occluded;   ///< A word a ray: what was found.
  FloatArray arrived;   ///< A pixel of the picture: the share of rays that arrive.
  UintArray ray_count;  ///< One word: rays to be traced are added to it.
  int width;
  int height;
  int sub_maps;
  int count;           ///< Texels a sub-map.
  int first_tile_row;  ///< Rows of tiles before these.
  int rays_per_pixel;
  uint mask;  ///< Of the rays.
  uint seed;
};

struct RestructureArguments {
  RsmTexelArray rendered;
  RsmTexelArray sub_maps;
  int resolution;
  int count;  ///< Of sub-maps along an edge.
};

const int kMaxBlurTaps = 8;
/// A blur's tile, and how far its taps may reach.
const int kBlurTile = 16;
const int kMaxBlurReach = 8;

struct BlurArguments {
  DeviceGuide guide;
  UintArray light;
  UintArray blurred;  ///< As `light`, or, relit at last, not written.
  Vec3Array picture;  ///< Relit irradiance [W/m^2].
  int width;
  int height;
  int unit;  ///< Distance of taps of 1 [pixels of the picture].
  int reach;
  float inverse_tolerance;  ///< One over RsmSettings::plane_tolerance.
  int tap_count;
  int distances[kMaxBlurTaps];
  float weights[kMaxBlurTaps];
};

/// From a picture of 1 / downscale of the size, whose view and light these are, to the frame's
/// surfaces.
struct UpsampleArguments {
  DeviceView small;
  Vec3Array light;
  DeviceView surfaces;
  Vec3Array irradiance;
  int small_width;
  int small_height;
  int width;
  int height;
  int first_row;  ///< Of the frame, which the surfaces begin with.
  float inverse_downscale;
  float plane_tolerance;
};

LAMBENT_END
#endif
