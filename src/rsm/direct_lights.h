// SPDX-License-Identifier: Apache-2.0
// Deals lights to sub-maps: which lights a pixel tests for its direct light.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lambent/rsm.h"
#include "rsm/direct_share.h"

namespace lambent {

struct DealtLights {
  std::size_t lights = 0;            ///< Number of lights in the scene.
  std::size_t per_sub_map = 0;       ///< Number of lights that a pixel tests.
  std::vector<AssignedLight> dealt;  ///< `per_sub_map` for each sub-map, in order of their index.

  /// Whether lights are shared out: a pixel does not test all of them.
  bool shared() const { return per_sub_map < lights; }
  std::span<const AssignedLight> of(int sub_map) const {
    return std::span(dealt).subspan(static_cast<std::size_t>(sub_map) * per_sub_map, per_sub_map);
  }
};

/// Deals `lights` lights to settings.sub_maps^2 sub-maps: settings.direct_lights to each, or as
/// many as it takes to deal all; all to each where settings.direct_lights is 0.
DealtLights deal_direct_lights(std::size_t lights, const RsmSettings& settings);

/// Width of the blur of arriving shares [pixels]: the period in which lights are shared out; 1: no
/// blur.
int share_period(const DealtLights& lights, const RsmSettings& settings);

}  // namespace lambent
