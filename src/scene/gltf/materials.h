// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/gltf/textures.h"

namespace lambent::gltf {

/// All materials of the file, with a default one (specification, sec. 3.9.6) at the end.
Expected<std::vector<Material>> import_materials(Document& document, const LoadOptions& options,
                                                 TextureLibrary& textures);

}  // namespace lambent::gltf
