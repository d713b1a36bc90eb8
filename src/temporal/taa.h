// SPDX-License-Identifier: Apache-2.0
// Temporal anti-aliasing of a sequence of pictures.
#pragma once

#include <span>
#include <vector>

#include "lambent/image.h"
#include "temporal/taa_records.h"

namespace lambent {

/// How a frame differs from the one before.
struct FrameChange {
  bool same_size = true;
  bool moved = false;   ///< The camera has.
  bool edited = false;  ///< The world differs in any way, ...
  bool relit = false;   ///< ... in lights, materials, what they emit or the sky.
};

/// Where a sequence of frames is at, on whatever backend they are made.
class TaaSequence {
 public:
  /// Forgets all frames so far.
  void restart() { *this = TaaSequence(); }
  /// Moves on to the next frame, of this size.
  void advance(int width, int height, const FrameChange& change);

  const TaaFrame& frame() const { return frame_; }
  /// Frames before this one. Sample s of n in each pixel is at jitter_position(index() * n + s).
  uint index() const { return index_; }

 private:
  TaaFrame frame_{};
  uint index_ = 0;
  uint resting_frames_ = 0;  // of the camera
  uint quiet_frames_ = 0;    // of the world
  bool begun_ = false;
};

/// The filter and its history on the processor.
class TemporalAntialiasing {
 public:
  /// Filters a frame's picture in place. `motion` is that of its pixels. The history is that of the
  /// call before, where the frame has one.
  void resolve(const TaaFrame& frame, std::span<const PixelMotion> motion, Image& picture);

 private:
  std::vector<TaaPixel> history_, result_;
};

}  // namespace lambent
