// SPDX-License-Identifier: Apache-2.0
// The passes of a frame, as a backend supplies them; frame.cpp says in which order they run.
#pragma once

#include <cstdint>
#include <memory>

#include "compose/gbuffer.h"
#include "lambent/renderer.h"

namespace lambent {

/// What a frame is made of.
struct FrameRequest {
  const World& world;
  const IndirectSources& sources;
  const Camera& camera;
  const FrameSettings& settings;
};

/// Passes over bands of rows. Each call leaves its result for those that follow, and its rays and
/// time in the frame that `finish` fills. All live as long as the frame is made.
class FramePasses {
 public:
  virtual ~FramePasses() = default;

  /// Once, before all bands: reflective shadow maps and what they light.
  virtual void rsm() = 0;
  /// What the camera sees in a band, one sample a pixel; starts the band's sample.
  virtual void gbuffer(const Band& band, int sample) = 0;
  /// What lights and emissive surfaces send straight.
  virtual void direct() = 0;
  /// Light of the field on each surface, looked up or gathered, less what is taken out of it.
  virtual void indirect() = 0;
  /// Light of the field from where a mirror would show it.
  virtual void glossy() = 0;
  /// Light of the maps on each surface, added to the field's where there is one.
  virtual void rsm_upsample() = 0;
  /// Adds the band's sample to the layers, with a share of the pixels' light.
  virtual void compose(float share) = 0;
  /// After all bands: layers, rays and times.
  virtual void finish(RenderedFrame& frame) = 0;
};

std::unique_ptr<FramePasses> make_frame_passes_cpu(const FrameRequest& request);
/// For worlds on a device.
std::unique_ptr<FramePasses> make_frame_passes_vulkan(const FrameRequest& request);

}  // namespace lambent
