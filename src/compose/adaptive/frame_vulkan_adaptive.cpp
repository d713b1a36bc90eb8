// SPDX-License-Identifier: Apache-2.0
// Further samples of some pixels on a device: which ones is found on the processor.
#include <algorithm>

#include "compose/frame_vulkan.h"
#include "compose/layers.h"
#include "core/image/exposure.h"

namespace lambent {

void FramePassesVulkan::read_luminances(std::vector<float>& luminances) {
  const FrameSettings& settings = request_->settings;
  luminances.resize(static_cast<std::size_t>(settings.width) *
                    static_cast<std::size_t>(settings.height));
  const auto pixels = static_cast<std::uint32_t>(luminances.size());
  reserve<float>(pixels, "luminances", memory_.luminances);
  add("denoise", [=, this](Recorder& to) {
    const LuminancesArguments arguments = {
        {memory_.layers.address()}, {memory_.luminances.address()}, pixels, 0u};
    to.run(kernels_.luminances, arguments, pixels);
  });
  run_steps();
  vulkan::read(device_, memory_.luminances, std::span(luminances));
}

float FramePassesVulkan::exposure() {
  LayeredImage& image = frame_->image;
  shape_layers(request_->settings.width, request_->settings.height, image);
  read_layers(image);
  return display_stops(image);
}

std::uint32_t FramePassesVulkan::sampled_pixels(std::uint32_t first, std::uint32_t count) const {
  const std::span<const std::uint8_t> skipped = request_->round.skipped;
  if (skipped.empty()) return count;
  const auto pixels = skipped.subspan(first, count);
  return static_cast<std::uint32_t>(std::count(pixels.begin(), pixels.end(), 0));
}

void FramePassesVulkan::refine(const FrameRequest& request, float kept) {
  request_ = &request;
  const std::vector<uint> skipped(request.round.skipped.begin(), request.round.skipped.end());
  const auto pixels = static_cast<std::uint32_t>(skipped.size());
  reserve<uint>(pixels, "pixels without samples", memory_.skipped);
  vulkan::write(device_, std::span<const uint>(skipped), memory_.skipped);
  add("compose", [=, this](Recorder& to) {
    const ScaleLayersArguments arguments = {
        {memory_.layers.address()}, {memory_.skipped.address()}, pixels, kept};
    to.run(kernels_.scale_layers, arguments, pixels);
  });
}

}  // namespace lambent
