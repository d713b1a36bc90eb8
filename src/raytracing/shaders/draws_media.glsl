// SPDX-License-Identifier: Apache-2.0
// The media that light of drawn candidates passes.
#include "raytracing/vulkan/shading_records.h"
#include "shared/phase.h"

#define MediaRef LightDrawsArguments
uint media_count(LightDrawsArguments draws) {
  return draws.media_count;
}
MediumRecord fetch_medium(LightDrawsArguments draws, uint medium) {
  return draws.media.at[medium];
}

#include "scene/media/media.inl.h"
