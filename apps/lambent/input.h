// SPDX-License-Identifier: Apache-2.0
// The files that subcommands read: whether they are there, and of the kind that is read.
#pragma once

#include <string>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent::cli {

/// Fails where there is no such image, naming the nearest file beside it, and where the file is
/// something else that we know, saying what it is and which subcommand reads it.
Expected<void> check_image_input(const std::string& path);

/// check_image_input for a file of lambent bake.
Expected<void> check_field_input(const std::string& path);

/// check_image_input for a scene: the name of a built-in one, or a glTF file. The nearest name may
/// also be that of a built-in scene.
Expected<void> check_scene_input(const std::string& path_or_name);

/// The scene that was asked for by the name of a built-in one or the path of a glTF file. Fails as
/// check_scene_input does, and where the file is broken.
Expected<Scene> open_scene_input(const std::string& path_or_name, const LoadOptions& options = {});

}  // namespace lambent::cli
