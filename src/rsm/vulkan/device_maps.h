// SPDX-License-Identifier: Apache-2.0
// What the passes take on a device that make maps and bring their texels together.
#ifndef LAMBENT_RSM_VULKAN_DEVICE_MAPS_H
#define LAMBENT_RSM_VULKAN_DEVICE_MAPS_H

#include "raytracing/vulkan/shading_records.h"
#include "rsm/maps/choice.h"
#include "rsm/vulkan/device_passes.h"

LAMBENT_BEGIN

/// A ray a texel.
struct MapRaysArguments {
  RayArray rays;
  MapProjection projection;
  int resolution;
  uint mask;  ///< Of the rays.
};

/// The texels of a light's map, from what its rays met.
struct MapTexelsArguments {
  SceneArray scene;
  RayArray rays;
  HitArray hits;
  RsmTexelArray texels;
  MapProjection projection;
  int resolution;
  uint light;  ///< Index among the scene's.
  uint unused;
};

/// The texels of a camera's map, from what its rays met and how that was lit.
struct CameraTexelsArguments {
  SceneArray scene;
  RayArray rays;
  HitArray hits;
  LitPointArray points;
  ShadedHitArray shaded;
  Vec3Array irradiance;
  RsmTexelArray texels;
  MapProjection projection;
  int resolution;
  uint unused;
};

/// Points of the view: kViewPoints positions, then as many normals; those beyond the last see
/// nothing.
struct ViewPointsArguments {
  DeviceView view;
  Vec3Array points;
  IntArray count;
  int width;
  int height;
  uint seed;
  uint unused;
};

/// kBlockSurfaces clusters of each block of a map, block after block, row after row.
struct ClusterArguments {
  RsmTexelArray texels;
  ClusterArray clusters;
  int resolution;
  int blocks;  ///< Along an edge.
};

/// What clusters bring to points.
struct WeighArguments {
  Vec3Array points;
  ClusterArray clusters;
  int count;  ///< Of clusters.
  uint unused;
};

LAMBENT_END
#endif
