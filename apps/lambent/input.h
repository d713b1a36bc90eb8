// SPDX-License-Identifier: Apache-2.0
// Checks of files that subcommands read: whether they exist, and have the expected kind.
#pragma once

#include <string>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent::cli {

/// Fails where there is no such image, with the most similar file name in the folder, and where the
/// file is of another known kind, with that kind and the subcommand that reads it.
Expected<void> check_image_input(const std::string& path);

/// Like check_image_input, for a field's file of `lambent bake`.
Expected<void> check_field_input(const std::string& path);

/// Like check_image_input, for a scene: the name of a built-in one, or a glTF file. The suggestion
/// may also be a built-in scene.
Expected<void> check_scene_input(const std::string& path_or_name);

/// Opens a scene by the name of a built-in one or the path of a glTF file. Fails as
/// check_scene_input does, and where the file is broken.
Expected<Scene> open_scene_input(const std::string& path_or_name, const LoadOptions& options = {});

}  // namespace lambent::cli
