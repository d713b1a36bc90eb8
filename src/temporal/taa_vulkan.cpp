// SPDX-License-Identifier: Apache-2.0
#include "temporal/taa_vulkan.h"

#include <utility>

#include "shaders/taa_resolve_comp.h"
#include "shaders/taa_show_comp.h"
#include "vulkan/device.h"

namespace lambent {

TaaKernels::TaaKernels(const vulkan::Device& device)
    : resolve(device, shaders::taa_resolve_comp(), "temporal anti-aliasing"),
      show(device, shaders::taa_show_comp(), "show anti-aliased") {}

TaaVulkan::TaaVulkan(const vulkan::Device& device)
    : device_(device), kernels_(device.kept<TaaKernels>()) {}

void TaaVulkan::reserve(const TaaFrame& frame) {
  const std::size_t pixels =
      static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  history_.reserve(device_, pixels * sizeof(TaaPixel), "kept pixels");
  result_.reserve(device_, pixels * sizeof(TaaPixel), "anti-aliased pixels");
}

void TaaVulkan::record(vulkan::Recorder& to, const TaaFrame& frame, FloatArray picture,
                       std::uint32_t stride, PixelMotionArray motion) {
  const TaaArguments arguments = {
      frame, stride, picture, motion, {history_.address()}, {result_.address()}};
  const auto pixels = static_cast<std::uint32_t>(frame.width * frame.height);
  to.run(kernels_.resolve, arguments, pixels);
  to.barrier();
  to.run(kernels_.show, arguments, pixels);
  std::swap(history_, result_);
}

}  // namespace lambent
