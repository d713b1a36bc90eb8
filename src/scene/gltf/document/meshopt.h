// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Fills Document::decompressed_views (one entry per buffer view; EXT_meshopt_compression).
Expected<void> decompress_views(Document& document);

}  // namespace lambent::gltf
