// SPDX-License-Identifier: Apache-2.0
// Temporal anti-aliasing of a sequence of pictures.
#pragma once

#include <span>
#include <vector>

#include "lambent/image.h"
#include "temporal/taa_records.h"

namespace lambent {

/// How a frame differs from the previous one.
struct FrameChange {
  bool same_size = true;
  bool moved = false;      ///< The camera has moved.
  bool edited = false;     ///< The world differs in any way.
  std::size_t moving = 0;  ///< Largest number of boxes around what moved in an update of the world.
  bool relit = false;      ///< Lights, materials, emission or the sky differ.
};

/// The state of a sequence of frames, for all backends.
class TaaSequence {
 public:
  /// Discards all frames so far.
  void restart() { *this = TaaSequence(); }
  /// Advances to the next frame, of this size.
  void advance(int width, int height, const FrameChange& change);

  const TaaFrame& frame() const { return frame_; }
  /// Number of frames before this one. Sample s of n is at jitter_position(index() * n + s).
  uint index() const { return index_; }

 private:
  TaaFrame frame_{};
  uint index_ = 0;
  uint resting_frames_ = 0;  // since the camera last moved
  uint quiet_frames_ = 0;    // since the world last changed
  // The most boxes that moved in one of the last frames, and the number of frames since
  std::size_t most_moving_ = 0;
  uint frames_since_most_ = 0;
  bool begun_ = false;
};

/// The filter and its history on the processor.
class TemporalAntialiasing {
 public:
  /// Filters a frame's picture in place. `motion`: motion vectors of its pixels. The history is the
  /// result of the previous call; it is read where frame.has_history.
  void resolve(const TaaFrame& frame, std::span<const PixelMotion> motion, Image& picture);

 private:
  std::vector<TaaPixel> history_, result_;
};

}  // namespace lambent
