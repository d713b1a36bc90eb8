// SPDX-License-Identifier: Apache-2.0
// The light of a sample of a band of rows, and how it is added to a frame's layers.
#pragma once

#include <vector>

#include "compose/gbuffer.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/glossy/seen_through.h"
#include "compose/layers.h"

namespace lambent {

/// The light of one sample of a band.
struct BandLight {
  ReflectedLight direct;
  std::vector<vec3> irradiance;          // indirect, on the surface
  bool has_indirect = false;             // `irradiance` is filled in
  bool looked_up = false;                // it was looked up in the field
  bool is_filtered = false;              // it is gathered, and shown once it was filtered
  std::vector<vec3> mirror_irradiance;   // indirect, on a surface that faces coat_direction()
  CoatLight coats;                       // light of coats from rays; empty: no rays
  bool coats_are_filtered = false;       // that light is shown once it was filtered
  std::vector<vec3> clearcoats;          // light of clearcoats; empty: from mirror_irradiance
  TransmittedLight transmitted;          // transmitted light; empty: no glass
  bool transmitted_is_filtered = false;  // that light is shown once it was filtered
  std::vector<vec4> fog;                 // in front of the pixels, see fog_along(); or empty
};

/// Adds a band's sample to the layers, times `share_of_sample` and the weights of its pixels.
void accumulate(const Camera& camera, const GBuffer& gbuffer, const BandLight& light,
                const ShownPixels& shown, float share_of_sample, Layers& layers);

}  // namespace lambent
