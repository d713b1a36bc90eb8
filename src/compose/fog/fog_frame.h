// SPDX-License-Identifier: Apache-2.0
// Fog of a frame: what it asks of src/fog, and what its pixels are seen through.
#pragma once

#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "fog/fog.h"

namespace lambent {

/// The fog of a frame's traced rows.
FogRequest fog_request(const FrameRequest& request);

/// What fog adds to each of a band's pixels, and takes, as of fog_along.
void find_fog(const FrameRequest& request, const FroxelFog& fog, const Band& band, int sample,
              const GBuffer& gbuffer, std::vector<glm::vec4>& light);

}  // namespace lambent
