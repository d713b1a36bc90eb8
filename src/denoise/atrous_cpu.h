// SPDX-License-Identifier: Apache-2.0
// A pass of the filter on the processor.
#pragma once

#include "core/cross_bilateral.h"
#include "denoise/atrous_pass.h"

namespace lambent {

/// Pixels of a row, as planes with guards.
struct AtrousRow {
  ConstPlanes guide;  ///< Starts at the row's first pixel, as the other planes do.
  ConstPlanes lobes;  ///< Read where the pass has lobes.
  ConstPlanes in;
  Planes out;
  std::ptrdiff_t guide_row, lobe_row, light_row;  ///< Floats from a row to the next one.
  int count;                                      ///< Number of pixels.
};

/// Filters a row. Single-threaded.
void filter_row(const AtrousPass& pass, const AtrousRow& row);

}  // namespace lambent
