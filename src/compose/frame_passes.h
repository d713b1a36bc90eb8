// SPDX-License-Identifier: Apache-2.0
// The passes of a frame, as a backend supplies them; frame.cpp says in which order they run.
#pragma once

#include <cstdint>
#include <memory>

#include "compose/gbuffer.h"
#include "field/correction/correction_use.h"
#include "fog/fog.h"
#include "lambent/renderer.h"
#include "temporal/taa.h"

namespace lambent {

class DeviceWorld;
struct FrameBefore;

/// What a frame is made of; all of it in range.
struct FrameRequest {
  const World& world;
  const IndirectSources& sources;
  const Camera& camera;
  const FrameSettings& settings;
  const FrameBefore* before = nullptr;    ///< Null: there is none of this size.
  bool light_continues = false;           ///< The world has not changed since the frame before.
  std::uint32_t first_sample = 0;         ///< Which of all samples the frame's first one is.
  const TaaSequence* sequence = nullptr;  ///< Null: the frame is not anti-aliased over time.

  /// As of subpixel_position.
  std::uint32_t jitter() const { return sequence != nullptr ? 1 + sequence->index() : 0; }
};

/// Whether light is averaged over frames.
inline bool averages(const FrameSettings& settings) {
  return settings.averaged_frames > 1;
}

/// Whether motion of pixels is found.
inline bool wants_motion(const FrameSettings& settings) {
  return settings.motion || averages(settings) || settings.temporal_antialiasing;
}

/// Whether indirect light is gathered by rays of the pixels.
inline bool gathers(const FrameRequest& request) {
  return request.sources.field != nullptr && request.settings.gather_rays > 0;
}

/// Whether the field is looked up at pixels: as their indirect light, or as the base that gathered
/// light is filtered with.
inline bool looks_up(const FrameRequest& request) {
  return request.sources.field != nullptr && (!gathers(request) || request.settings.denoise);
}

/// Whether pixels' indirect light is that of a lookup.
inline bool is_looked_up(const FrameRequest& request) {
  return request.sources.field != nullptr && !gathers(request);
}

/// How lookups at pixels are corrected. Where light comes from a small patch, corrections are
/// learned from gathers most of which miss it, and their cells differ. Shown as they are they are
/// better than none; under light that is filtered, or combined with what other means find of the
/// same pixels, they would come back as spots on walls.
inline CorrectionUse pixel_correction(const FrameRequest& request) {
  const bool alone = is_looked_up(request) && request.sources.subtracted_field == nullptr;
  return alone ? CorrectionUse::smooth : CorrectionUse::none;
}

/// Whether coats reflect by rays of their own.
inline bool traces_coats(const FrameRequest& request) {
  return request.sources.field != nullptr && request.settings.glossy_rows > 0;
}

/// Whether lights without extent are asked in the sub-images of reflective shadow maps, rather than
/// by every sample.
inline bool asks_lights_in_sub_images(const FrameRequest& request) {
  return request.sources.rsm && request.sources.rsm->direct;
}

/// Whether there is fog.
inline bool has_fog(const FrameRequest& request) {
  return has_fog(request.world.scene());
}

/// Rows that are traced: where light is filtered, also those that it is filtered with.
Band traced_rows(const FrameRequest& request);

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
  /// Before all bands: light in the fog of the whole view; of scenes that have fog.
  virtual void light_fog() = 0;
  /// What the camera sees in a band, one sample a pixel; starts the band's sample.
  virtual void gbuffer(const Band& band, int sample) = 0;
  /// Where what they show was in the frame before; of frames that want it.
  virtual void motion() = 0;
  /// What lights and emissive surfaces send straight; the latter alone where lights are asked in
  /// sub-images, ...
  virtual void direct() = 0;
  /// ... whose light is then added.
  virtual void rsm_direct() = 0;
  /// Light of the field on each surface, looked up, less what is taken out of it.
  virtual void indirect() = 0;
  /// Light on each surface from rays of its own, which end in the field's.
  virtual void gather() = 0;
  /// Light that coats reflect, by rays of their own or from the field.
  virtual void glossy() = 0;
  /// Light that comes through surfaces.
  virtual void transmission() = 0;
  /// Light of the maps on each surface, added to the field's where there is one.
  virtual void rsm_upsample() = 0;
  /// What fog between the camera and each pixel's surface adds and takes; of scenes that have fog.
  virtual void fog() = 0;
  /// Adds the band's sample to the layers, with a share of the pixels' light; what is filtered is
  /// kept for that.
  virtual void compose(float share) = 0;
  /// After all bands of a sample: filters what was kept and adds it to the layers.
  virtual void denoise(float share) = 0;
  /// After all bands: filters the whole picture over the frames so far; of frames that want it.
  virtual void antialias() = 0;
  /// After all bands: layers, rays and times are in the frame.
  virtual void finish() = 0;
};

std::unique_ptr<FramePasses> make_frame_passes_cpu();
/// For worlds on a device.
std::unique_ptr<FramePasses> make_frame_passes_vulkan(const DeviceWorld& world);

}  // namespace lambent
