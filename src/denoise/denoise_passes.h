// SPDX-License-Identifier: Apache-2.0
// The passes of the filter for given settings, on every backend.
#pragma once

#include <vector>

#include "denoise/atrous_pass.h"
#include "lambent/denoise.h"

namespace lambent {

/// The passes, in order.
std::vector<AtrousPass> denoise_passes(const DenoiseSettings& settings, bool has_base,
                                       bool measured, bool has_levels, bool has_lobes);

}  // namespace lambent
