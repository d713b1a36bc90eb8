// SPDX-License-Identifier: Apache-2.0
// Filtering of light whose rare bright rays are stored apart.
#pragma once

#include <span>
#include <vector>

#include "lambent/denoise.h"

namespace lambent {

/// Filters the light of rare bright rays, without regard to differences of light, and adds it to
/// the light that is filtered already. `detail`: light whose differences from pixel to pixel it
/// takes in proportion; empty: it is even. `scratch`: memory that is reused.
void add_excess(const DenoiseView& view, std::span<const glm::vec3> excess,
                std::span<const glm::vec3> detail, const DenoiseSettings& settings,
                Denoiser& denoiser, std::vector<glm::vec3>& scratch, std::span<glm::vec3> filtered);

/// Filters gathered light, and adds its excess.
void filter_gathered(const DenoiseView& view, const NoisyLight& light,
                     std::span<const glm::vec3> excess, Denoiser& denoiser,
                     std::vector<glm::vec3>& scratch, std::span<glm::vec3> filtered);

}  // namespace lambent
