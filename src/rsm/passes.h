// SPDX-License-Identifier: Apache-2.0
// The passes of a gather over a mosaic, in order. Each uses all cores; they run one at a time.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "lambent/rsm.h"
#include "rsm/maps/lights.h"
#include "rsm/mosaic.h"

namespace lambent {

/// Whether light is blurred, and therefore gathered such that it can be relit.
bool blurs(const RsmSettings& settings);

/// RsmPattern::whole: copies the view into the mosaic, which restructures it where there are
/// several sub-images, and gathers `lights` at every pixel. Both happen row by row, so that copied
/// rows are still in the cache. Returns the number of rays traced for visibility.
std::uint64_t gather_whole(const World& world, const RsmView& view, const RsmLights& lights,
                           const RsmSettings& settings, Mosaic& mosaic);

/// RsmPattern::disk: copies the view in the same way, and gathers the texels of each of `maps` maps
/// around every pixel's projection.
void gather_disks(const RsmView& view, std::size_t maps, const FetchMap& fetch,
                  const RsmSettings& settings, Mosaic& mosaic);

/// Blurs the light inside each of m x m sub-images, horizontally, then vertically.
void blur_sub_images(std::span<const BlurTap> taps, const RsmSettings& settings, Mosaic& mosaic);

/// Interleaves the light into a picture, rows from the top; with taps, blurs it at the
/// picture's resolution on the way.
void interleave(std::span<const BlurTap> taps, const RsmSettings& settings, Mosaic& mosaic,
                std::span<glm::vec3> picture);

}  // namespace lambent
