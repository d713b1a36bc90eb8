// SPDX-License-Identifier: Apache-2.0
// Direct light of directional, point and spot lights, computed in the sub-images of a view on a
// Vulkan device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lambent/rsm.h"
#include "raytracing/vulkan/hit_shading.h"
#include "rsm/direct_lights.h"
#include "rsm/vulkan/device_direct.h"
#include "rsm/vulkan/passes_vulkan.h"
#include "vulkan/buffer.h"
#include "vulkan/device.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// Kernels that are compiled for a number of sub-images along an edge of the picture.
struct RsmDirectKernels {
  RsmDirectKernels(const vulkan::Device& device, int sub_images);
  vulkan::Kernel rays, sent, sum;
};

/// Computes the light, and keeps its buffers from frame to frame: 24 bytes a pixel, 100 where
/// lights are shared out, and 69 to 140 MB of rays.
class RsmDirectVulkan {
 public:
  /// The device must outlive it.
  explicit RsmDirectVulkan(const vulkan::Device& device);

  /// Starts a view of this size, and deals `lights` lights to its sub-images.
  void start(std::size_t lights, const RsmSettings& settings, int width, int height);

  /// Number of rows of a band that has about `pixels` pixels.
  int rows_of_a_band(std::uint32_t pixels) const;
  /// Makes room for bands of this many rows; earlier recordings must have run.
  void reserve_band(int rows);
  /// Records the light of a band of rows, whose pixels are in these arrays, and a barrier. The
  /// first row is a multiple of rows_of_a_band().
  void record_band(vulkan::Recorder& recorder, const DeviceStage& stage, const DevicePixels& pixels,
                   int first_row, int rows);
  /// After all bands: records the blur of arriving shares, where lights are shared out.
  void record_finish(vulkan::Recorder& recorder, const RsmViewOnDevice& view);
  /// Number of shadow rays of the view. Waits for the device.
  std::uint64_t rays() const;

  /// Records the upsampling of the view's light to `count` pixels of a frame, from `first_row` on.
  /// `camera` is the view's.
  void record_upsampling(vulkan::Recorder& recorder, const RsmViewOnDevice& view,
                         const DevicePixels& pixels, const Camera& camera, int width, int first_row,
                         std::uint32_t count, const DeviceReflectedLight& light) const;

 private:
  struct Groups {
    std::uint32_t width, height;  // invocations of a dispatch
    std::uint32_t invocations() const { return width * height; }
  };
  Groups groups(int rows) const;
  /// Records the tracing of the rays of `slots` slots, and the sum of the light that arrives: as
  /// light in `target` or, if `is_share`, as shares.
  void record_sum(vulkan::Recorder& recorder, const DeviceStage& stage, int first_row, int rows,
                  int first_slot, int slots, const vulkan::Buffer& target, bool is_share);
  /// Number of slots of a band of this many rows that are processed at once.
  int slots_at_once(int rows) const;
  const RsmDirectKernels& kernels();

  const vulkan::Device& device_;
  RsmSettings settings_;
  int width_ = 0, height_ = 0;
  DealtLights lights_;
  vulkan::Buffer dealt_, direct_, brightest_, brightest_light_, shares_, blurred_;
  vulkan::Buffer shadow_rays_, pairs_, arrived_, ray_count_;
};

}  // namespace lambent
