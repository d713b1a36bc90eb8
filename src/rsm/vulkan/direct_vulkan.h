// SPDX-License-Identifier: Apache-2.0
// Direct light of directional, point and spot lights, found in the sub-images of a view on a Vulkan
// device.
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

/// Compiled for a number of sub-images along an edge of the picture.
struct RsmDirectKernels {
  RsmDirectKernels(const vulkan::Device& device, int sub_images);
  vulkan::Kernel rays, sent, sum;
};

/// Finds the light, and keeps it there from frame to frame: 24 bytes a pixel, 100 where lights are
/// shared out, and 69 to 140 MB of rays.
class RsmDirectVulkan {
 public:
  /// The device must outlive it.
  explicit RsmDirectVulkan(const vulkan::Device& device);

  /// Starts a view of that size: deals so many lights to its sub-images.
  void start(std::size_t lights, const RsmSettings& settings, int width, int height);

  /// Rows of a band that has about so many pixels.
  int rows_of_a_band(std::uint32_t pixels) const;
  /// Records what makes room for bands of so many rows; what was recorded before must have run.
  void reserve_band(int rows);
  /// Records the light of a band of rows, whose pixels lie in these arrays; the first row is a
  /// multiple of rows_of_a_band. Then a barrier.
  void record_band(vulkan::Recorder& recorder, const DeviceStage& stage, const DevicePixels& pixels,
                   int first_row, int rows);
  /// After all bands: records that lights which are shared out are brought together.
  void record_finish(vulkan::Recorder& recorder, const RsmViewOnDevice& view);
  /// Shadow rays of the view. Waits.
  std::uint64_t rays() const;

  /// Records that `count` pixels of a frame, from `first_row` on, take their light from the view.
  /// `camera` is the view's.
  void record_upsampling(vulkan::Recorder& recorder, const RsmViewOnDevice& view,
                         const DevicePixels& pixels, const Camera& camera, int width, int first_row,
                         std::uint32_t count, const DeviceReflectedLight& light) const;

 private:
  struct Groups {
    std::uint32_t width, height;  // of a dispatch
    std::uint32_t invocations() const { return width * height; }
  };
  Groups groups(int rows) const;
  /// Records that the rays of so many slots are traced, and what arrives summed: as light of
  /// `target`, or where `is_share`, as shares.
  void record_sum(vulkan::Recorder& recorder, const DeviceStage& stage, int first_row, int rows,
                  int first_slot, int slots, const vulkan::Buffer& target, bool is_share);
  /// Slots of a band of so many rows that are worked on at once.
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
