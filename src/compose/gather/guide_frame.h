// SPDX-License-Identifier: Apache-2.0
// The pilot of a frame, which guides the rays that gather its light.
#pragma once

#include <cstdint>

#include "compose/frame_passes.h"
#include "gather/guide.h"

namespace lambent {

/// Makes the guide of a frame. Returns the number of rays traced.
std::uint64_t guide_frame(const FrameRequest& request, GatherGuide& guide);

}  // namespace lambent
