// SPDX-License-Identifier: Apache-2.0
// Fog of a frame on a device. The processor lights the froxels, with rays traced by the device and
// lookups of the field there: a picture has far fewer froxels than pixels. The fog's effect on each
// pixel is computed on the device.
#include "compose/fog/fog_frame.h"
#include "compose/frame_vulkan.h"
#include "core/pass_times.h"

namespace lambent {

void FramePassesVulkan::light_fog() {
  Stopwatch watch;
  FrameMemory& m = memory_;
  frame_->rays += m.fog.find_light(fog_request(*request_), false);
  const std::vector<MediumRecord>& media = m.fog.media().records();
  const std::span<const vec4> froxels = m.fog.froxels();
  reserve<MediumRecord>(media.size(), "fog", m.media);
  reserve<vec4>(froxels.size(), "froxels", m.froxels);
  reserve<FogRecord>(1, "where fog is", m.fog_record);
  vulkan::write(device_, std::span<const MediumRecord>(media), m.media);
  vulkan::write(device_, froxels, m.froxels);
  const FogRecord record = {m.fog.grid(),
                            {m.media.address()},
                            {m.froxels.address()},
                            static_cast<uint>(media.size()),
                            0u};
  vulkan::write(device_, std::span<const FogRecord>(&record, 1), m.fog_record);
  add_pass_time(frame_->passes, "fog", watch.lap());
}

void FramePassesVulkan::fog() {
  reserve<vec4>(pixels_, "fog of pixels", memory_.pixel_fog);
  add("fog", [this](Recorder& to) {
    const FrameSettings& s = request_->settings;
    const FogPixelsArguments arguments = {{memory_.fog_record.address()},
                                          {memory_.rays.address()},
                                          {memory_.hits.address()},
                                          {memory_.pixel_fog.address()},
                                          static_cast<uint>(s.width),
                                          first_pixel_,
                                          pixels_,
                                          sample_,
                                          static_cast<uint>(s.samples),
                                          s.seed,
                                          request_->jitter(),
                                          0u};
    to.run(kernels_.fog_pixels, arguments, pixels_);
  });
}

DeviceStage FramePassesVulkan::stage() const {
  DeviceStage stage{world_.scene(), world_.tracer()};
  if (!has_fog(*request_)) return stage;
  stage.media = {{memory_.media.address()},
                 static_cast<std::uint32_t>(memory_.fog.media().records().size())};
  return stage;
}

}  // namespace lambent
