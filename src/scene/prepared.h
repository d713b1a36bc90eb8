// SPDX-License-Identifier: Apache-2.0
// Scenes in a file format that mirrors their layout in memory and is read without any other
// library: for machines with little more than a compiler, and only for Lambent's own tools. Other
// versions of Lambent refuse such files.
#pragma once

#include <string>

#include "lambent/scene.h"

namespace lambent {

/// Writes a scene in its current pose, without its animations and its rig. Writes a whole file or
/// none.
Expected<void> save_prepared(const Scene& scene, const std::string& path);

/// Reads what save_prepared wrote. Fails, naming the place, on files that are cut short, broken or
/// of another version, and on scenes that `validate` refuses.
Expected<Scene> load_prepared(const std::string& path);

/// Drops the finest levels of textures until no side is longer than `texels`, >= 1.
void limit_textures(Scene& scene, int texels);

}  // namespace lambent
