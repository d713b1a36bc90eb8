// SPDX-License-Identifier: Apache-2.0
// The state of a frame that temporal anti-aliasing reads, and the arguments of its kernel.
#ifndef LAMBENT_TEMPORAL_TAA_RECORDS_H
#define LAMBENT_TEMPORAL_TAA_RECORDS_H

#include "raytracing/motion/motion_math.h"
#include "temporal/taa_math.h"

LAMBENT_BEGIN

/// A frame of a sequence.
struct TaaFrame {
  int width, height;  ///< [pixels]
  uint has_history;   ///< 0: there is no history.
  /// Standard deviations of each pixel's neighbourhood that the history is clipped to; 0: not
  /// clipped.
  float clip_deviations;
  uint relit;         ///< 1: lights, materials or the sky differ from the previous frame.
  float most_frames;  ///< Most frames that the history of pixels at rest counts for.
  /// 1: pixels remember their other samples, as the camera has not moved since the previous frame,
  /// and nothing has begun to move.
  uint keeps_others;
};

LAMBENT_DEVICE_ARRAY(TaaPixelArray, TaaPixel, 4)

/// All pixels of a frame, and their history.
struct TaaArguments {
  TaaFrame frame;
  uint stride;
  FloatArray picture;  ///< Radiance: three floats a pixel, the first of each `stride`.
  PixelMotionArray motion;
  TaaPixelArray history;
  TaaPixelArray result;
};

LAMBENT_END
#endif
