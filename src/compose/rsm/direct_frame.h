// SPDX-License-Identifier: Apache-2.0
// Direct light of directional, point and spot lights, computed in the sub-images of the small view
// of reflective shadow maps, on the processor.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "lambent/rsm.h"
#include "rsm/direct_lights.h"

namespace lambent {

/// Direct light of a view's pixels, rows from the top; memory is reused.
struct DirectView {
  DealtLights lights;
  /// Reflected to the camera; diffuse light is divided by filtered_albedo().
  std::vector<ReflectedPair> direct;
  /// Where lights are shared out: the light of each pixel's brightest one, which every pixel tests
  /// itself. Until finish_direct_view(), `direct` holds the unoccluded light of all others.
  std::vector<ReflectedPair> brightest;
  std::vector<LightShare> shares, blurred;  ///< Unoccluded and arriving light that a pixel tested.
};

/// Makes room for a view of this many pixels.
void start_direct_view(const World& world, const RsmSettings& settings, std::size_t pixels,
                       DirectView& view);

/// Computes the light of a band of the view's rows, `width` pixels each. Returns the number of
/// shadow rays traced.
std::uint64_t shade_direct_view(const World& world, const RsmSettings& settings,
                                const GBuffer& gbuffer, const Band& band, int width,
                                DirectView& view);

/// After all bands: where lights are shared out, scales each pixel's light by the share that
/// arrives around it.
void finish_direct_view(const RsmView& seen, const RsmSettings& settings, DirectView& view);

}  // namespace lambent
