// SPDX-License-Identifier: Apache-2.0
// The passes of a frame, as a backend supplies them; frame.cpp says in which order they run.
#pragma once

#include <cstdint>
#include <memory>

#include "compose/gbuffer.h"
#include "lambent/renderer.h"

namespace lambent {

class DeviceWorld;

/// What a frame is made of; all of it in range.
struct FrameRequest {
  const World& world;
  const IndirectSources& sources;
  const Camera& camera;
  const FrameSettings& settings;
};

/// Passes over bands of rows, of one frame after the other: always of the same world and sources.
/// Each call leaves its result for those that follow, and its rays and time in the frame.
class FramePasses {
 public:
  virtual ~FramePasses() = default;

  /// Starts a frame, whose layers, rays and times are cleared. Both live until `finish`.
  virtual void begin(const FrameRequest& request, RenderedFrame& frame) = 0;
  /// Before all bands: reflective shadow maps and what they light. Left out where those of the
  /// frame before serve this one, too.
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
  /// After all bands: layers, rays and times are in the frame.
  virtual void finish() = 0;
};

std::unique_ptr<FramePasses> make_frame_passes_cpu();
/// For worlds on a device.
std::unique_ptr<FramePasses> make_frame_passes_vulkan(const DeviceWorld& world);

}  // namespace lambent
