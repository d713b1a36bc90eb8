// SPDX-License-Identifier: Apache-2.0
// Finds how much of a scene's lights is visible from where, by shadow rays from random surfaces.
#pragma once

#include "lambent/world.h"
#include "scene/light_tree/light_visibility.h"

namespace lambent {

/// Tests the lights of a world's tree from the surfaces around them. Empty where the tree has no
/// two lights, or nothing is around them. The same bits on any number of threads.
LightVisibility learn_light_visibility(const World& world);

/// The same with fewer rays, for a tree that was built anew after an edit.
LightVisibility learn_of_new_lights(const World& world);

/// Follows edits of the scene's geometry and lights, to which the world was updated: tests some of
/// the lights again. It takes some milliseconds; picks by a table that has not yet followed have
/// more noise, but the same expectation.
void renew_light_visibility(const World& world, LightVisibility& visibility);

}  // namespace lambent
