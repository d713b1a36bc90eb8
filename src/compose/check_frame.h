// SPDX-License-Identifier: Apache-2.0
// Validation of frame requests.
#pragma once

#include "compose/frame_passes.h"

namespace lambent {

/// Fails with the first part of a request that is out of range or does not fit the other parts.
Expected<void> check(const FrameRequest& request);

/// Fails where this size or this camera is invalid.
Expected<void> check_view(const Camera& camera, int width, int height);

}  // namespace lambent
