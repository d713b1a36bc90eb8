// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace lambent {

/// Paths of the files to which a .gltf or .glb refers: buffers and images that it does not contain.
/// Reads only its JSON. Empty where the file cannot be read; load_scene then reports the cause.
std::vector<std::string> files_of_gltf(const std::string& path);

}  // namespace lambent
