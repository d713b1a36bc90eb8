// SPDX-License-Identifier: Apache-2.0
// Temporal anti-aliasing on a device.
#pragma once

#include "temporal/taa_records.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// The kernels, owned by the device (Device::kept).
struct TaaKernels {
  explicit TaaKernels(const vulkan::Device& device);
  vulkan::Kernel resolve, show;
};

/// The filter and its history on a device; see TemporalAntialiasing.
class TaaVulkan {
 public:
  explicit TaaVulkan(const vulkan::Device& device);

  /// Makes room for a frame's pixels. No unfinished recording may use the buffers.
  void reserve(const TaaFrame& frame);
  /// Records the filtering of a picture in place: three floats a pixel, the first of each `stride`.
  /// What it reads must be visible; its results are visible after a barrier.
  void record(vulkan::Recorder& to, const TaaFrame& frame, FloatArray picture, std::uint32_t stride,
              PixelMotionArray motion);

 private:
  const vulkan::Device& device_;
  const TaaKernels& kernels_;
  vulkan::Buffer history_, result_;
};

}  // namespace lambent
