// SPDX-License-Identifier: Apache-2.0
// Arguments of the passes on a device that compute direct light in the sub-images of a view. They
// process bands of its rows, which begin at multiples of the sub-images: places below are a band's.
#ifndef LAMBENT_RSM_VULKAN_DEVICE_DIRECT_H
#define LAMBENT_RSM_VULKAN_DEVICE_DIRECT_H

#include "raytracing/vulkan/shading_records.h"
#include "rsm/direct_share.h"
#include "rsm/vulkan/device_passes.h"

LAMBENT_BEGIN

/// Lights of a band's pixels, and their shadow rays. Slots are stored one after the other, each
/// with one ray for each invocation, workgroup after workgroup.
struct DirectRaysArguments {
  SceneArray scene;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  RayArray shadow_rays;      ///< Mask 0 where the slot has no light.
  ReflectedPairArray pairs;  ///< Weighted light of a slot if its ray is unoccluded.
  UintArray ray_count;       ///< One number: rays drawn so far.
  MediumArray media;
  DealtLightArray dealt;  ///< Lights of one sub-map after the other.
  /// For the whole view: unoccluded light of all lights but the brightest, and the index of that
  /// one; written by rsm_direct_sent where lights are shared out. Otherwise addresses are 0.
  ReflectedPairArray direct;
  UintArray brightest;
  int width;      ///< Width of the view [pixels].
  int first_row;  ///< First row of the band.
  int rows;
  int sub_maps;
  int per_sub_map;  ///< Number of lights that a pixel tests.
  int first_slot;   ///< First of these lights that is processed.
  int slots;        ///< Number of these lights that are processed.
  int lights;       ///< Number of lights in the scene.
  uint media_count;
  uint is_shared;
};

/// Sums up the light that arrives.
struct DirectSumArguments {
  ReflectedPairArray pairs;
  UintArray occluded;
  Vec3Array through;          ///< Replaces `occluded` where dims_shadows is 1.
  ReflectedPairArray direct;  ///< Result for the view where lights are not shared out.
  LightShareArray shares;     ///< Result for the view where lights are shared out.
  int width;
  int first_row;
  int rows;
  int slots;
  uint is_first;  ///< 1: sums start with these slots.
  uint is_shared;
  uint dims_shadows;
  uint unused;
};

/// One direction of the blur of arriving and unoccluded light.
struct DirectBlurArguments {
  DeviceView view;
  LightShareArray shares;
  LightShareArray blurred;       ///< Written by the first direction.
  ReflectedPairArray brightest;  ///< Arriving light of each pixel's brightest light.
  ReflectedPairArray
      direct;  ///< Unoccluded light of the others; the last direction writes the sum.
  int width;
  int height;
  int period;
  float inverse_tolerance;  ///< One over RsmSettings::plane_tolerance.
  uint is_last;
  uint unused;
};

/// Upsamples the view's light to a band of a frame.
struct DirectUpsampleArguments {
  DeviceView view;
  ReflectedPairArray direct;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array diffuse;  ///< Of the frame's pixels; light is added here and to `specular`.
  Vec3Array specular;
  int view_width;
  int view_height;
  int width;
  int first_row;
  uint count;
  float inverse_downscale;
  float plane_tolerance;
  vec3 camera_ws;
  vec3 camera_back;  ///< Unit; against the direction of view.
};

LAMBENT_END
#endif
