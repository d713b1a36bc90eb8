// SPDX-License-Identifier: Apache-2.0
// Scenes as they stand in memory, in a file that is read without any other library: for machines
// that have little more than a compiler, and for our own tools alone. Another version of Lambent
// refuses it.
#pragma once

#include <string>

#include "lambent/scene.h"

namespace lambent {

/// Writes everything of a scene but its animations and its rig, whole or not at all: it stays as it
/// is posed now.
Expected<void> save_prepared(const Scene& scene, const std::string& path);

/// Reads what save_prepared wrote. Fails, naming the place, on files that are cut short, broken or
/// of another version, and on scenes that `validate` refuses.
Expected<Scene> load_prepared(const std::string& path);

/// Drops the finest levels of textures until no side is longer than `texels`, >= 1.
void limit_textures(Scene& scene, int texels);

}  // namespace lambent
