// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "lambent/scene.h"

namespace lambent {

/// Imports a .gltf or .glb that is in memory and refers to no files: load_scene without the disk.
Expected<Scene> load_scene_from_memory(std::span<const std::uint8_t> bytes,
                                       const LoadOptions& options = {});

}  // namespace lambent
