// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace lambent {

/// Paths of the files that a .gltf or .glb refers to: buffers and images that it does not hold
/// itself. Reads its JSON alone. Empty where the file cannot be read: load_scene tells why.
std::vector<std::string> files_of_gltf(const std::string& path);

}  // namespace lambent
