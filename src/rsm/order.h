// SPDX-License-Identifier: Apache-2.0
// The order of the passes of a gather, for all backends, which implement the passes.
#pragma once

#include <span>

#include "core/cross_bilateral.h"
#include "lambent/rsm.h"

namespace lambent {

/// Stages of a gather whose light can be stored as a picture.
enum class RsmStage { gathered, interleaved, blurred };
inline constexpr int kRsmStages = 3;

/// The passes, which process buffers of their own.
class RsmPasses {
 public:
  virtual ~RsmPasses() = default;
  /// Called around each group of passes that is timed together.
  virtual void begin(const char* name) = 0;
  virtual void end() = 0;
  /// Restructures the view and gathers light at every pixel.
  virtual void gather() = 0;
  /// Blurs the light inside each sub-image, horizontally, then vertically.
  virtual void blur_sub_images(std::span<const BlurTap> taps) = 0;
  /// Interleaves the light into the picture; with taps, blurs it at the picture's resolution.
  virtual void interleave(std::span<const BlurTap> taps) = 0;
  /// Stores the picture of a stage; `blurred` is the final picture itself.
  virtual void keep(RsmStage stage) = 0;
};

/// Runs the passes that the settings ask for.
void run_rsm_passes(const RsmSettings& settings, bool keep_stages, RsmPasses& passes);

/// Farthest pixel that the blurs read [pixels of the picture].
int blur_reach(const RsmSettings& settings);

/// Adds a stored stage as layers: "rsm.mosaic", and otherwise the stage's name.
void add_stage_layers(RsmStage stage, std::span<const glm::vec3> picture,
                      const RsmSettings& settings, RsmIrradiance& result);

}  // namespace lambent
