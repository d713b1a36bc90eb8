// SPDX-License-Identifier: Apache-2.0
// Whether the light of texels arrives, asked of the few that bring most.
#pragma once

#include <cstdint>
#include <span>

#include "lambent/rsm.h"
#include "lambent/world.h"
#include "rsm/gather.h"

namespace lambent {

/// Dims each pixel of a row by the share of its light that arrives: the share of `rays` shadow rays
/// that find nothing in their way to texels drawn with probability in proportion to what they
/// bring. Unbiased in luminance. `first_pixel` and `pixel_step` number the row's pixels, each with
/// random numbers of its own. Returns the rays traced.
std::uint64_t dim_by_visibility(const World& world, const GatherRow& row,
                                std::span<const RsmTexel> texels, int rays, std::size_t first_pixel,
                                std::size_t pixel_step, std::uint32_t seed);

}  // namespace lambent
