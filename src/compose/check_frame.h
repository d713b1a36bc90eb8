// SPDX-License-Identifier: Apache-2.0
// What a frame cannot be made of.
#pragma once

#include "compose/frame_passes.h"

namespace lambent {

/// Fails with the first part of a frame that is out of range, or does not go with the others.
Expected<void> check(const FrameRequest& request);

/// Fails where a picture of this size, or by this camera, cannot be made.
Expected<void> check_view(const Camera& camera, int width, int height);

}  // namespace lambent
