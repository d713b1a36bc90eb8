// SPDX-License-Identifier: Apache-2.0
// The passes of a frame, which a backend implements; frame.cpp runs them in order.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compose/gbuffer.h"
#include "field/correction/correction_use.h"
#include "fog/fog.h"
#include "lambent/renderer.h"
#include "temporal/taa.h"

namespace lambent {

class DeviceWorld;
struct ChangedLight;
struct FrameBefore;

/// Everything that a frame is rendered from; all of it in range.
struct FrameRequest {
  const World& world;
  const IndirectSources& sources;
  const Camera& camera;
  const FrameSettings& settings;
  const FrameBefore* before = nullptr;    ///< Null: there is no previous frame of this size.
  bool light_continues = false;           ///< The world has not changed since the previous frame.
  const ChangedLight* changed = nullptr;  ///< How it has changed; null where that is unknown.
  std::uint32_t first_sample = 0;         ///< Index of the frame's first sample among all samples.
  const TaaSequence* sequence = nullptr;  ///< Null: no temporal anti-aliasing.
  SampleRound round = {};                 ///< Which samples are taken, and of which pixels.

  /// Index of a sample among those of all frames, so that each frame draws other random numbers.
  int drawn(int sample) const { return sample + static_cast<int>(first_sample); }
  /// The argument `jitter` of subpixel_position().
  std::uint32_t jitter() const { return sequence != nullptr ? 1 + sequence->index() : 0; }
};

/// Whether light is averaged over frames.
inline bool averages(const FrameSettings& settings) {
  return settings.averaged_frames > 1;
}

/// Whether the motion of pixels is computed. Averages of light need none: they follow the camera.
inline bool wants_motion(const FrameSettings& settings) {
  return settings.motion || settings.temporal_antialiasing;
}

/// Whether indirect light is gathered by rays from the pixels.
inline bool gathers(const FrameRequest& request) {
  return request.sources.field != nullptr && request.settings.gather_rays > 0;
}

// Rays that gather the light of a pixel, over those for what it shows in a mirror or behind glass.
// Both weaken what they show. A quarter of the rays left clouds on walls behind panes, which few of
// the further samples of a pixel reached (FurtherSamples.ComeCloserToMany...).
constexpr int kGathersOverShown = 2;

/// Rays that gather the light of what a pixel shows in its mirror, and of that behind its glass, a
/// sample.
inline int shown_gather_rays(const FrameSettings& settings) {
  return settings.gather_rays / kGathersOverShown;
}

/// Whether the surfaces that pixels show in mirrors or behind glass gather light, where theirs is
/// filtered.
inline bool gathers_shown(const FrameRequest& request) {
  return gathers(request) && shown_gather_rays(request.settings) > 0;
}

/// Whether a pilot guides these rays.
inline bool guides_gathers(const FrameRequest& request) {
  return gathers(request) && request.settings.guides_gathers && request.settings.gather_rays > 1;
}

/// Whether the field is looked up at pixels: for their indirect light, or for the base that
/// gathered light is filtered with.
inline bool looks_up(const FrameRequest& request) {
  return request.sources.field != nullptr && (!gathers(request) || request.settings.denoise);
}

/// Whether the pixels' indirect light comes from lookups.
inline bool is_looked_up(const FrameRequest& request) {
  return request.sources.field != nullptr && !gathers(request);
}

/// How lookups at pixels are corrected. Where light comes from a small patch, corrections are
/// learned from gathers most of which miss it, so that neighbouring cells differ. Shown directly,
/// they are better than none. Under light that is filtered, or that is combined with another
/// method's light at the same pixels, they would show as spots on walls.
inline CorrectionUse pixel_correction(const FrameRequest& request) {
  const bool alone = is_looked_up(request) && request.sources.subtracted_field == nullptr;
  return alone ? CorrectionUse::smooth : CorrectionUse::none;
}

/// Whether coats reflect light from rays of their own.
inline bool traces_coats(const FrameRequest& request) {
  return request.sources.field != nullptr && request.settings.glossy_rows > 0;
}

/// Whether direct light of point, spot and directional lights is computed in the sub-images of
/// reflective shadow maps, rather than by every sample.
inline bool asks_lights_in_sub_images(const FrameRequest& request) {
  return request.sources.rsm && request.sources.rsm->direct;
}

/// Whether there is fog.
inline bool has_fog(const FrameRequest& request) {
  return has_fog(request.world.scene());
}

/// The rows to trace: those that are shown and, where light is filtered, those in the filter's
/// reach.
Band traced_rows(const FrameRequest& request);

/// Passes over bands of rows, for one frame after the other, always of the same world and sources.
/// Each call stores its result for later passes, and adds its rays and time to the frame.
class FramePasses {
 public:
  virtual ~FramePasses() = default;

  /// Starts a frame: clears its layers, rays and times. The request and the frame must live until
  /// `finish`.
  virtual void begin(const FrameRequest& request, RenderedFrame& frame) = 0;
  /// Before all bands: renders reflective shadow maps and gathers their light. Skipped where the
  /// previous frame's are still valid.
  virtual void rsm() = 0;
  /// Before all bands: finds where most of the light that pixels gather comes from. See
  /// guides_gathers(). Skipped where the previous frame's guide is still valid.
  virtual void guide() = 0;
  /// Before all bands: lights the fog of the whole view. For scenes that have fog.
  virtual void light_fog() = 0;
  /// Traces a band's primary rays, a sample of each pixel that the round does not skip; starts the
  /// band's sample. Pixels that are skipped show nothing from here on.
  virtual void gbuffer(const Band& band, int sample) = 0;
  /// Computes where the pixels' surfaces were in the previous frame, in the first round. See
  /// wants_motion().
  virtual void motion() = 0;
  /// Direct light of lights and emissive surfaces; of the latter alone where lights are computed in
  /// sub-images.
  virtual void direct() = 0;
  /// Adds the direct light that was computed in sub-images.
  virtual void rsm_direct() = 0;
  /// Indirect light from lookups of the field, less what `subtracted_field` contributes.
  virtual void indirect() = 0;
  /// Indirect light from rays of each pixel, which end in lookups of the field.
  virtual void gather() = 0;
  /// Light that coats reflect, from rays of their own or from the field.
  virtual void glossy() = 0;
  /// Indirect light of the surfaces that the pixels' mirrors show, from rays of these. See
  /// gathers_in_mirrors().
  virtual void gather_in_mirrors() = 0;
  /// Light that is transmitted through surfaces.
  virtual void transmission() = 0;
  /// Indirect light of the first opaque surfaces behind glass, from rays of these. See
  /// gathers_behind_glass().
  virtual void gather_behind_glass() = 0;
  /// Adds the light of reflective shadow maps to the field's, if any.
  virtual void rsm_upsample() = 0;
  /// Inscattered light and transmittance of the fog in front of each pixel. For scenes with fog.
  virtual void fog() = 0;
  /// Adds the band's sample to the layers, times `share`; light that is to be filtered is stored
  /// instead.
  virtual void compose(float share) = 0;
  /// After all bands of a sample: filters the stored light and adds it to the layers.
  virtual void denoise(float share) = 0;
  /// After all bands of a sample: the luminances of the picture's pixels so far, row after row.
  virtual void read_luminances(std::vector<float>& luminances) = 0;
  /// After all bands of a sample: the exposure of the picture so far [stops].
  virtual float exposure() = 0;
  /// After all bands of a sample: goes on with another request for the same picture, which must
  /// live until `finish`. Multiplies the layers of the pixels that it does not skip by `kept`.
  virtual void refine(const FrameRequest& request, float kept) = 0;
  /// After all bands: temporal anti-aliasing of the whole picture, for frames that ask for it.
  virtual void antialias() = 0;
  /// After all bands: completes the frame's layers, rays and times.
  virtual void finish() = 0;
};

std::unique_ptr<FramePasses> make_frame_passes_cpu();
/// The device's passes; the world is on that device and must outlive them.
std::unique_ptr<FramePasses> make_frame_passes_vulkan(const DeviceWorld& world);

}  // namespace lambent
