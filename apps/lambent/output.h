// SPDX-License-Identifier: Apache-2.0
// Where subcommands write to.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lambent/error.h"

namespace lambent::cli {

/// What pictures as a display shows them may end in.
inline constexpr std::initializer_list<const char*> kPictureEndings = {".png", ".jpg", ".jpeg"};

/// Fails where a file could not be written, folders that are yet to be made included: before any
/// work is done for it. Makes nothing.
Expected<void> check_place(const std::string& path);

/// check_place, and fails where the name does not end in one of `endings` (".png").
Expected<void> check_output(const std::string& path, std::initializer_list<const char*> endings);

/// check_place for files of Lambent's own (`what`: "a field"), which may end in anything but what
/// other kinds of files end in: a picture, a scene, statistics.
Expected<void> check_own_output(const std::string& path, const std::string& what);

/// Makes the folders that a file is to lie in, where they are missing: right before it is written,
/// so that work that fails leaves none behind.
Expected<void> make_folders(const std::string& path);

/// Writes what --stats asks for, with the folders that are missing.
Expected<void> write_statistics(const std::string& path, const nlohmann::ordered_json& statistics);

/// Where the picture of a scene goes when nobody says where: "scene.png" beside "scene.glb", and
/// "cornell.png" in the current folder for the built-in scene of that name.
std::string picture_beside(const std::string& scene);

}  // namespace lambent::cli
