// SPDX-License-Identifier: Apache-2.0
// What the passes take on a device that find direct light in the sub-images of a view. They work on
// bands of its rows, of which the first is a multiple of the sub-images: places below are a band's.
#ifndef LAMBENT_RSM_VULKAN_DEVICE_DIRECT_H
#define LAMBENT_RSM_VULKAN_DEVICE_DIRECT_H

#include "raytracing/vulkan/shading_records.h"
#include "rsm/direct_share.h"
#include "rsm/vulkan/device_passes.h"

LAMBENT_BEGIN

/// Lights of a band's pixels, and rays that ask whether they arrive. Slots lie one after the other,
/// each with one ray for each invocation, workgroup after workgroup.
struct DirectRaysArguments {
  SceneArray scene;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  RayArray shadow_rays;      ///< Mask 0 where nothing is to be had.
  ReflectedPairArray pairs;  ///< What arrives by a ray, if anything does; weighted.
  UintArray ray_count;       ///< Rays drawn so far: one number.
  MediumArray media;
  DealtLightArray dealt;  ///< Sub-map after sub-map.
  /// The view's: what all lights but the brightest send, and which that is; written by
  /// rsm_direct_sent, where lights are shared out. Else no address.
  ReflectedPairArray direct;
  UintArray brightest;
  int width;      ///< Of the view [pixels].
  int first_row;  ///< Of the band.
  int rows;
  int sub_maps;
  int per_sub_map;  ///< Lights that a pixel asks,
  int first_slot;   ///< of which this is the first one,
  int slots;        ///< and these are so many.
  int lights;       ///< Of the scene.
  uint media_count;
  uint is_shared;
};

/// Sums what arrives.
struct DirectSumArguments {
  ReflectedPairArray pairs;
  UintArray occluded;
  Vec3Array through;          ///< In place of it where has_glass is 1.
  ReflectedPairArray direct;  ///< The view's, ...
  LightShareArray shares;     ///< ... or these where lights are shared out.
  int width;
  int first_row;
  int rows;
  int slots;
  uint is_first;  ///< 1: sums start with these slots.
  uint is_shared;
  uint has_glass;
  uint unused;
};

/// A direction of the blur of what arrives and what is sent.
struct DirectBlurArguments {
  DeviceView view;
  LightShareArray shares;
  LightShareArray blurred;       ///< Written by the first direction.
  ReflectedPairArray brightest;  ///< What arrives of each pixel's brightest light.
  ReflectedPairArray direct;     ///< That of the others, dimmed by the last one, and both added up.
  int width;
  int height;
  int period;
  float inverse_tolerance;  ///< One over RsmSettings::plane_tolerance.
  uint is_last;
  uint unused;
};

/// From the view's light to a band of a frame's.
struct DirectUpsampleArguments {
  DeviceView view;
  ReflectedPairArray direct;
  LitPointArray points;
  PixelSurfaceArray surfaces;
  Vec3Array diffuse;  ///< Of the frame's pixels; light is added, as it is to the next.
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
