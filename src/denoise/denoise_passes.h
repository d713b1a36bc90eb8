// SPDX-License-Identifier: Apache-2.0
// The passes of the filter for given settings, on every backend.
#pragma once

#include <cstdint>
#include <vector>

#include "denoise/atrous_pass.h"
#include "lambent/denoise.h"

namespace lambent {

/// What the noise of light is estimated from: pixels around it, earlier pictures, or its samples.
enum class NoiseFrom : std::uint8_t { neighbours, history, samples };

/// The passes, in order.
std::vector<AtrousPass> denoise_passes(const DenoiseSettings& settings, bool has_base,
                                       NoiseFrom noise_from, bool has_levels, bool has_lobes);

/// Most passes that spread fireflies, over 15 x 15 pixels. With five, small spots of light that few
/// samples find were spread over walls.
inline constexpr int kFireflyPasses = 3;

/// The settings by which fireflies are spread: without regard to differences of light.
DenoiseSettings firefly_denoising(DenoiseSettings settings);

}  // namespace lambent
