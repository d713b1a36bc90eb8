// SPDX-License-Identifier: Apache-2.0
// The filter on a Vulkan device: compute kernels over buffers.
#pragma once

#include <cstdint>

#include "denoise/denoise_records.h"
#include "lambent/denoise.h"
#include "shaders/denoise_finish_comp.h"
#include "shaders/denoise_pass_comp.h"
#include "shaders/denoise_start_comp.h"
#include "vulkan/buffer.h"
#include "vulkan/device.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// DenoiseView in a device's memory.
struct DenoiseViewOnDevice {
  std::uint32_t width = 0, height = 0;
  Vec3Array positions_ws;
  Vec3Array normals_ws;
  FloatArray depths;
  LobeGuideArray lobes = {};  ///< Address 0 where the light comes from the hemisphere.
};

/// NoisyLight in a device's memory, without history_variance: light is averaged over pictures on
/// the processor alone. Addresses are 0 where there is no base, variance or level.
struct NoisyLightOnDevice {
  Vec3Array light;
  Vec3Array base = {};
  FloatArray variance = {};
  FloatArray levels = {};
};

/// The kernels, owned by the device (Device::kept).
struct DenoiseKernels {
  explicit DenoiseKernels(const vulkan::Device& device)
      : start(device, shaders::denoise_start_comp(), "denoise start"),
        pass(device, shaders::denoise_pass_comp(), "denoise pass"),
        finish(device, shaders::denoise_finish_comp(), "denoise finish") {}
  vulkan::Kernel start, pass, finish;
};

/// Filters pictures on a device, one after the other. Owns buffers there: 64 bytes a pixel.
class DenoiserVulkan {
 public:
  /// The device must outlive it.
  explicit DenoiserVulkan(const vulkan::Device& device);

  /// Makes room for pictures of this many pixels. No unfinished recording may use the buffers.
  void reserve(std::size_t pixels);

  /// Records Denoiser::filter, with a barrier after each kernel. Sizes and settings must be in
  /// range, and reserve() must have made room. `adds`: adds to the contents of `filtered`.
  void record(vulkan::Recorder& to, const DenoiseViewOnDevice& view,
              const NoisyLightOnDevice& light, const DenoiseSettings& settings, Vec3Array filtered,
              bool adds = false) const;

 private:
  /// Records the filter of a part of the light: kWholeLight, kWithoutFireflies or kFirefliesAlone.
  void record_part(vulkan::Recorder& to, const DenoiseViewOnDevice& view,
                   const NoisyLightOnDevice& light, uint part, const DenoiseSettings& settings,
                   Vec3Array filtered, bool adds) const;

  const vulkan::Device& device_;
  const DenoiseKernels& kernels_;
  vulkan::Buffer light_[2];
};

}  // namespace lambent
