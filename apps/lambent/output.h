// SPDX-License-Identifier: Apache-2.0
// Output paths of subcommands.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lambent/error.h"

namespace lambent::cli {

/// File endings of display-encoded pictures.
inline constexpr std::initializer_list<const char*> kPictureEndings = {".png", ".jpg", ".jpeg"};

/// File endings of rendered pictures.
inline constexpr std::initializer_list<const char*> kFrameEndings = {".png", ".jpg", ".jpeg",
                                                                     ".exr"};

/// Fails where a file could not be written, including folders that would have to be made. To be
/// called before any work is done. Creates nothing.
Expected<void> check_place(const std::string& path);

/// check_place, and fails where the name does not end in one of `endings` (".png").
Expected<void> check_output(const std::string& path, std::initializer_list<const char*> endings);

/// Fails where layers are asked for and the output is no .exr, which alone has any.
Expected<void> check_layers(bool layers, const std::string& output);

/// check_place for Lambent's own formats (`what`: "a field"), which may have any ending except
/// those of pictures, scenes and statistics.
Expected<void> check_own_output(const std::string& path, const std::string& what);

/// Creates the missing folders of a file's path. To be called right before the file is written, so
/// that failed work leaves no folders behind.
Expected<void> make_folders(const std::string& path);

/// Writes the file of --stats, and creates missing folders.
Expected<void> write_statistics(const std::string& path, const nlohmann::ordered_json& statistics);

/// The default path for the picture of a scene: "scene.png" beside "scene.glb", and "cornell.png"
/// in the current folder for the built-in scene of that name.
std::string picture_beside(const std::string& scene);

}  // namespace lambent::cli
