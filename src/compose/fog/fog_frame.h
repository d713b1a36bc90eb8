// SPDX-License-Identifier: Apache-2.0
// The fog of a frame: the request to src/fog, and its effect on pixels.
#pragma once

#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "fog/fog.h"

namespace lambent {

/// The fog of a frame's traced rows.
FogRequest fog_request(const FrameRequest& request);

/// Radiance that fog adds to each of a band's pixels, and its transmittance; see fog_along().
void find_fog(const FrameRequest& request, const FroxelFog& fog, const Band& band, int sample,
              const GBuffer& gbuffer, std::vector<glm::vec4>& light);

}  // namespace lambent
