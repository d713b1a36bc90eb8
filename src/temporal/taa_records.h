// SPDX-License-Identifier: Apache-2.0
// What temporal anti-aliasing is told of a frame, and the arguments of its kernel.
#ifndef LAMBENT_TEMPORAL_TAA_RECORDS_H
#define LAMBENT_TEMPORAL_TAA_RECORDS_H

#include "raytracing/motion/motion_math.h"
#include "temporal/taa_math.h"

LAMBENT_BEGIN

/// A frame of a sequence.
struct TaaFrame {
  int width, height;  ///< [pixels]
  uint has_history;   ///< 0: nothing is kept of a frame before.
  /// Standard deviations of each pixel's neighbourhood that the history is held to; 0: it is not.
  float clip_deviations;
  uint relit;         ///< 1: lights, materials or the sky differ from the frame before.
  float most_frames;  ///< That the history of what rests counts for.
};

LAMBENT_DEVICE_ARRAY(TaaPixelArray, TaaPixel, 4)

/// All pixels of a frame, and what is kept of them.
struct TaaArguments {
  TaaFrame frame;
  FloatArray picture;  ///< Radiance: three floats a pixel, the first of each `stride`.
  PixelMotionArray motion;
  TaaPixelArray history;
  TaaPixelArray result;
  uint stride;
  uint padding;
};

LAMBENT_END
#endif
