// SPDX-License-Identifier: Apache-2.0
// Direct light of directional, point and spot lights, found in the sub-images of the view that maps
// light: on the processor.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "lambent/rsm.h"
#include "rsm/direct_lights.h"

namespace lambent {

/// Direct light of the pixels of a view, rows from the top; its memory is used again.
struct DirectView {
  DealtLights lights;
  /// As reflected to the camera; diffuse light over filtered_albedo.
  std::vector<ReflectedPair> direct;
  /// Where lights are shared out: the light of each pixel's brightest one, which it always asks.
  /// Until `direct` is finished, that is the light of all others, as if nothing were in the way.
  std::vector<ReflectedPair> brightest;
  std::vector<LightShare> shares, blurred;  ///< Of the others that each asks.
};

/// Makes room for a view of so many pixels.
void start_direct_view(const World& world, const RsmSettings& settings, std::size_t pixels,
                       DirectView& view);

/// Finds the light of a band of the view's rows, `width` pixels each. Returns the shadow rays
/// traced.
std::uint64_t shade_direct_view(const World& world, const RsmSettings& settings,
                                const GBuffer& gbuffer, const Band& band, int width,
                                DirectView& view);

/// After all bands: where lights are shared out, dims each pixel's light by what arrives around it.
void finish_direct_view(const RsmView& seen, const RsmSettings& settings, DirectView& view);

}  // namespace lambent
