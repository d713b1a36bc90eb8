// SPDX-License-Identifier: Apache-2.0
// Arguments of the passes on a device that render maps and cluster their texels.
#ifndef LAMBENT_RSM_VULKAN_DEVICE_MAPS_H
#define LAMBENT_RSM_VULKAN_DEVICE_MAPS_H

#include "raytracing/vulkan/shading_records.h"
#include "rsm/maps/choice.h"
#include "rsm/vulkan/device_passes.h"

LAMBENT_BEGIN

/// Makes a ray for each texel.
struct MapRaysArguments {
  RayArray rays;
  MapProjection projection;
  int resolution;
  uint mask;  ///< Mask of the rays.
};

/// Computes the texels of a light's map from its rays' hits.
struct MapTexelsArguments {
  SceneArray scene;
  RayArray rays;
  HitArray hits;
  RsmTexelArray texels;
  MapProjection projection;
  int resolution;
  uint light;  ///< Index of the light in the scene.
  uint unused;
};

/// Computes the texels of a camera's map from its rays' hits and their direct light.
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

/// Finds points of the view: writes kViewPoints positions, then as many normals; unused entries
/// have no normal.
struct ViewPointsArguments {
  DeviceView view;
  Vec3Array points;
  IntArray count;
  int width;
  int height;
  uint seed;
  uint unused;
};

/// Writes kBlockSurfaces clusters for each block of a map, block after block, row after row.
struct ClusterArguments {
  RsmTexelArray texels;
  ClusterArray clusters;
  int resolution;
  int blocks;  ///< Number of blocks along an edge.
};

/// Computes the light of clusters at points.
struct WeighArguments {
  Vec3Array points;
  ClusterArray clusters;
  int count;  ///< Number of clusters.
  uint unused;
};

LAMBENT_END
#endif
