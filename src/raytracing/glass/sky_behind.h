// SPDX-License-Identifier: Apache-2.0
// The bright part of the sky behind rough surfaces, on the processor.
#pragma once

#include "raytracing/glass/transmitter.h"
#include "scene/environment_sampling.h"

namespace lambent {

#include "raytracing/glass/sky_behind.inl.h"

}  // namespace lambent
