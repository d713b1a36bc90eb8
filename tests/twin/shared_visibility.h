// SPDX-License-Identifier: Apache-2.0
// One table of the lights' visibility for two worlds.
#pragma once

#include <type_traits>

#include "raytracing/world_access.h"
#include "scene/light_tree/light_tree.h"

namespace lambent::test {

/// Has `there` pick lights by the table of `here`, a world of the same scene. Each tracer learns
/// its own, and those that round differently differ by a ray here and there. A pick between two
/// triangles of a lamp may then be the other one, which is noise alone.
inline void share_light_visibility(const World& here, const World& there) {
  const auto& state = WorldAccess::state_of(there);
  using State = std::remove_cvref_t<decltype(state)>;
  const_cast<State&>(state).set_light_visibility(lights_of(here).visibility());
}

}  // namespace lambent::test
