// SPDX-License-Identifier: Apache-2.0
// Visibility of texels, tested for the few that contribute most.
#pragma once

#include <cstdint>
#include <span>

#include "lambent/rsm.h"
#include "lambent/world.h"
#include "rsm/gather.h"

namespace lambent {

/// Scales the light of each pixel of a row by the share that arrives: the share of `rays` shadow
/// rays that are unoccluded, to texels sampled with probabilities in proportion to their light.
/// Unbiased in luminance. `first_pixel` and `pixel_step` number the row's pixels, each of which has
/// random numbers of its own. Returns the number of rays traced.
std::uint64_t apply_visibility(const World& world, const GatherRow& row,
                               std::span<const RsmTexel> texels, int rays, std::size_t first_pixel,
                               std::size_t pixel_step, std::uint32_t seed);

}  // namespace lambent
