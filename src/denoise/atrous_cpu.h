// SPDX-License-Identifier: Apache-2.0
// A pass of the filter on the processor.
#pragma once

#include "core/cross_bilateral.h"
#include "denoise/atrous_pass.h"

namespace lambent {

/// Pixels of a row, as planes whose guards see nothing.
struct AtrousRow {
  ConstPlanes guide;  ///< Of the row's first pixel, and so on.
  ConstPlanes lobes;  ///< Where there are some.
  ConstPlanes in;
  Planes out;
  std::ptrdiff_t guide_row, lobe_row, light_row;  ///< Floats from a row to the next one.
  int count;                                      ///< Pixels.
};

/// Filters a row. Single-threaded.
void filter_row(const AtrousPass& pass, const AtrousRow& row);

}  // namespace lambent
