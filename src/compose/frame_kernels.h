// SPDX-License-Identifier: Apache-2.0
// Kernels of frames on a device, and the memory that a renderer keeps there.
#pragma once

#include <mutex>

#include "compose/frame_records.h"
#include "compose/pixel_math.h"
#include "raytracing/vulkan/hit_shading.h"
#include "rsm/vulkan/gather_vulkan.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"

namespace lambent {

/// Kept by the device (Device::kept).
struct FrameKernels {
  explicit FrameKernels(const vulkan::Device& device);

  std::mutex in_use;  ///< Frames on a device take turns.
  vulkan::Kernel camera_rays, pixel_queries, gather_rays, ray_queries, gather_sum, replace_light,
      view_geometry, compose;
};

/// What a renderer keeps from frame to frame. Buffers grow as frames need them to.
struct FrameMemory {
  explicit FrameMemory(const vulkan::Device& device);

  HitShading pixel_shading, gather_shading;
  RsmMapperVulkan mapper;
  RsmGathererVulkan rsm;
  RsmMapsOnDevice maps;

  // Of a band's pixels
  vulkan::Buffer rays, hits, points, surfaces, diffuse, specular;
  vulkan::Buffer queries, irradiance, mirror_irradiance, subtracted_field, from_maps;
  // Of the rays that gather some pixels' light
  vulkan::Buffer gathering_rays, gathering_indices, gathered_hits, gathered_points, gathered,
      gathered_direct, gathered_field;
  // Positions, normals and depths of a band's pixels, and of the small picture that maps light
  vulkan::Buffer band_geometry[3], small_geometry[3];
  // Of the whole picture
  vulkan::Buffer layers;
};

}  // namespace lambent
