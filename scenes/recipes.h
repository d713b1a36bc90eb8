// SPDX-License-Identifier: Apache-2.0
// One function for each built-in scene; builtin.h describes them.
#pragma once

#include "scenes/builtin.h"

namespace lambent::scenes {

AnimatedScene make_cornell();
AnimatedScene make_cornell_spot();
AnimatedScene make_spheres();
AnimatedScene make_furnace();
AnimatedScene make_glass();
AnimatedScene make_furnace_sky();
AnimatedScene make_two_rooms();
AnimatedScene make_two_rooms_sealed();
AnimatedScene make_house();
AnimatedScene make_lamps();
AnimatedScene make_cube();
AnimatedScene make_squares_parallel();
AnimatedScene make_squares_perpendicular();
/// `texels` is the side of the largest textures; the others have half of it. At least 2.
AnimatedScene make_atrium(int texels = 1024);

}  // namespace lambent::scenes
