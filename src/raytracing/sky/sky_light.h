// SPDX-License-Identifier: Apache-2.0
// The bright part of the sky as a light of coats, on the processor.
#pragma once

#include "raytracing/coat_share.h"
#include "scene/environment_sampling.h"
#include "shared/brdf.h"
#include "shared/random.h"
#include "shared/reservoir.h"
#include "shared/sampling.h"

namespace lambent {

#include "raytracing/sky/sky_light.inl.h"

}  // namespace lambent
