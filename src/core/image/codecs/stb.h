// SPDX-License-Identifier: Apache-2.0
// The only file that includes the declarations of stb_image and stb_image_write; stb.cpp has their
// definitions.
#pragma once

#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_STDIO

#include <stb/stb_image.h>

#include <stb/stb_image_write.h>
