// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lambent/scene.h"

namespace lambent::scenes {

/// The bytes of a PNG file: RGB where every pixel is opaque, else RGBA.
std::string encode_png(const TextureLevel& image);

}  // namespace lambent::scenes
