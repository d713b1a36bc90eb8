// SPDX-License-Identifier: Apache-2.0
// The one way in which the library includes stb_image and stb_image_write; stb.cpp holds their
// code.
#pragma once

#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_STDIO

#include <stb/stb_image.h>

#include <stb/stb_image_write.h>
