// SPDX-License-Identifier: Apache-2.0
// tinygltf, reduced to the conversion of JSON to structs: no files, no images.
#pragma once

#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
// Debian's libdraco exports another version of tinygltf under the same names, and the dynamic
// linker would mix the two. This one is therefore renamed, and compiled in.
#define tinygltf lambent_tinygltf
#include <tiny_gltf.h>
