// SPDX-License-Identifier: Apache-2.0
// Further samples of the pixels whose samples differ visibly.
//
// After FrameSettings::samples samples of all pixels, those whose mean has a visible error double
// theirs, round by round. Each round's samples are stratified by themselves, so that every round
// shows see-through surfaces as much as they cover.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compose/adaptive/pixel_noise.h"
#include "compose/frame_passes.h"

namespace lambent {

/// Whether pixels of such a picture may take further samples.
bool takes_further_samples(const FrameSettings& settings);

class FurtherSamples {
 public:
  /// Both must outlive this, and this must outlive the frame.
  FurtherSamples(const FrameRequest& request, FramePasses& passes);

  /// To be called after each sample.
  void note_sample();
  /// Starts a round. Returns its request, whose settings have twice the samples of the last one:
  /// the second half of these are to be taken. Null where no pixel needs any.
  const FrameRequest* start_round();

 private:
  const FrameRequest& request_;
  FramePasses& passes_;
  std::vector<std::uint8_t> skipped_;  // see SampleRound
  std::vector<float> luminances_;      // scratch memory
  std::optional<PixelNoise> noise_;    // none where pixels take no further samples
  FrameSettings settings_;             // of the present round
  std::optional<FrameRequest> round_;  // none before the first one
};

}  // namespace lambent
