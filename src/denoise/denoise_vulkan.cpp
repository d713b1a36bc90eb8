// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise_vulkan.h"

#include "denoise/denoise_passes.h"

namespace lambent {

DenoiserVulkan::DenoiserVulkan(const vulkan::Device& device)
    : device_(device), kernels_(device_.kept<DenoiseKernels>()) {}

void DenoiserVulkan::reserve(std::size_t pixels) {
  for (vulkan::Buffer& light : light_) {
    light.reserve(device_, pixels * sizeof(DenoiseRecord), "filtered light");
  }
}

void DenoiserVulkan::record(vulkan::Recorder& to, const DenoiseViewOnDevice& view,
                            const NoisyLightOnDevice& light, const DenoiseSettings& settings,
                            Vec3Array filtered, bool adds) const {
  if (light.variance.address == 0 || light.levels.address == 0) {
    record_part(to, view, light, kWholeLight, settings, filtered, adds);
    return;
  }
  record_part(to, view, light, kWithoutFireflies, settings, filtered, adds);
  record_part(to, view, light, kFirefliesAlone, firefly_denoising(settings), filtered, true);
}

void DenoiserVulkan::record_part(vulkan::Recorder& to, const DenoiseViewOnDevice& view,
                                 const NoisyLightOnDevice& light, uint part,
                                 const DenoiseSettings& settings, Vec3Array filtered,
                                 bool adds) const {
  const std::uint32_t count = view.width * view.height;
  const bool has_base = light.base.address != 0, has_levels = light.levels.address != 0,
             has_lobes = view.lobes.address != 0;
  const bool measured = light.variance.address != 0 && part != kFirefliesAlone;
  const NoiseFrom noise_from = measured ? NoiseFrom::samples : NoiseFrom::neighbours;
  DenoiseArray from{light_[0].address()}, into{light_[1].address()};
  const DenoiseStartArguments start = {
      light.light, light.base, light.variance,     from,
      view.width,  count,      has_base ? 1u : 0u, light.variance.address != 0 ? 1u : 0u,
      part,        0u};
  to.run(kernels_.start, start, count);
  to.barrier();
  for (const AtrousPass& by :
       denoise_passes(settings, has_base, noise_from, has_levels, has_lobes)) {
    const DenoisePassArguments pass = {
        view.positions_ws, view.normals_ws, view.depths, light.levels, view.lobes, from, into, by,
        view.width,        view.height,     0u};
    to.run(kernels_.pass, pass, count);
    to.barrier();
    std::swap(from, into);
  }
  const DenoiseFinishArguments finish = {
      from, light.base, filtered, count, has_base ? 1u : 0u, adds ? 1u : 0u, 0u};
  to.run(kernels_.finish, finish, count);
  to.barrier();
}

}  // namespace lambent
