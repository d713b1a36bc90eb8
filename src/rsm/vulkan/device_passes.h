// SPDX-License-Identifier: Apache-2.0
// Arguments of the passes of a gather on a device. Pictures are arrays, rows from the top; mosaics
// are addressed by mosaic_index() (rsm/deinterleave.h).
#ifndef LAMBENT_RSM_VULKAN_DEVICE_PASSES_H
#define LAMBENT_RSM_VULKAN_DEVICE_PASSES_H

#include "raytracing/ray_records.h"
#include "rsm/maps/projection.h"
#include "rsm/pattern.h"
#include "rsm/records.h"

LAMBENT_BEGIN

/// What the camera sees; see RsmView in lambent/rsm.h.
struct DeviceView {
  Vec3Array positions_ws;
  Vec3Array normals_ws;
  FloatArray depths;
};

/// The same, restructured for blurs: 20 bytes a pixel.
struct DeviceGuide {
  Vec4Array points;   ///< Position [m], one over depth [1/m]; 0: nothing is seen.
  UintArray normals;  ///< encode_unit_vector().
};

/// The outputs of a gather.
struct GatherTarget {
  DeviceGuide guide;  ///< Written where light is blurred.
  /// Written where light is blurred: three planes of pack_upper_halves(), irradiance and R of
  /// shared/reorient_irradiance.h, red and x, green and y, blue and z.
  UintArray light;
  Vec3Array picture;   ///< Written where light is not blurred: irradiance [W/m^2].
  FloatArray arrived;  ///< With kGatherDimmed: share of the light that arrives; one a pixel.
};

const uint kGatherBlurred = 1u;  ///< Light will be blurred.
const uint kGatherDimmed = 2u;   ///< Light is scaled by GatherTarget::arrived.
/// Texels are read in the order as rendered, at the indices `places`.
const uint kGatherRendered = 4u;

/// Pixels of an invocation of rsm_gather, a tile's height apart: reading a texel from the
/// workgroup's memory, which takes as long as its arithmetic, then serves all of them.
const int kGatherPixels = 2;

struct RsmGatherArguments {
  DeviceView view;
  GatherTarget target;
  RsmTexelArray texels;
  UintArray places;
  int width;
  int height;
  int sub_maps;
  int count;  ///< Texels in a sub-map.
  uint flags;
  uint unused;
};

/// A map that a disk samples.
struct DiskMap {
  RsmTexelArray texels;
  DiskSampleArray samples;  ///< `count` samples for each sub-map, one sub-map after the other.
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
  int count;  ///< Samples for a sub-map.
  uint flags;
  float softening;
  uint unused;
};

/// Rays from pixels to texels of their sub-maps. They are stored workgroup after workgroup,
/// invocation after invocation, `rays_per_pixel` of each; those of pixels that gather nothing are
/// not traced.
struct VisibilityArguments {
  DeviceView view;
  RsmTexelArray texels;
  RayArray rays;
  UintArray occluded;  ///< The rays' results; a word a ray.
  FloatArray
      arrived;  ///< The share of rays that are unoccluded; one for each pixel of the picture.
  UintArray ray_count;  ///< One word, to which the number of traced rays is added.
  int width;
  int height;
  int sub_maps;
  int count;           ///< Texels in a sub-map.
  int first_tile_row;  ///< First row of tiles.
  int rays_per_pixel;
  uint mask;  ///< Mask of the rays.
  uint seed;
};

struct RestructureArguments {
  RsmTexelArray rendered;
  RsmTexelArray sub_maps;
  int resolution;
  int count;  ///< Number of sub-maps along an edge.
};

const int kMaxBlurTaps = 8;
/// Edge of a blur's tile, and the farthest tap [pixels of a sub-image].
const int kBlurTile = 16;
const int kMaxBlurReach = 8;

struct BlurArguments {
  DeviceGuide guide;
  UintArray light;
  UintArray blurred;  ///< The result, in the format of `light`; not written by the last blur.
  Vec3Array picture;  ///< Relit irradiance [W/m^2].
  int width;
  int height;
  int unit;  ///< Distance of a tap at distance 1 [pixels of the picture].
  int reach;
  float inverse_tolerance;  ///< One over RsmSettings::plane_tolerance.
  int tap_count;
  int distances[kMaxBlurTaps];
  float weights[kMaxBlurTaps];
};

/// Upsamples light from a picture of 1 / downscale of the size to the frame's surfaces.
struct UpsampleArguments {
  DeviceView small;
  Vec3Array light;
  DeviceView surfaces;
  Vec3Array irradiance;
  int small_width;
  int small_height;
  int width;
  int height;
  int first_row;  ///< First row of the surfaces, counted in the frame.
  float inverse_downscale;
  float plane_tolerance;
};

LAMBENT_END
#endif
