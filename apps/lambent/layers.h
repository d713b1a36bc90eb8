// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lambent/error.h"
#include "lambent/image.h"

namespace lambent::cli {

/// A layer's name for display, since the name of the whole picture is empty.
std::string layer_text(const std::string& name);

/// Whether a layer shows light or colours. Others are data, and have no exposure.
bool is_picture(const std::string& layer);

/// The layer of that name of the image that was read from `path`. Otherwise fails, listing the
/// existing layers and suggesting the nearest.
Expected<const Image*> find_layer(const std::string& path, const LayeredImage& image,
                                  const std::string& name);

}  // namespace lambent::cli
