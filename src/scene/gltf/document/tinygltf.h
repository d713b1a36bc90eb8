// SPDX-License-Identifier: Apache-2.0
// tinygltf, cut down to what the importer trusts it with: JSON to structs. No files, no images.
#pragma once

#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
// Debian's libdraco exports another version of tinygltf under the same names, and the loader would
// mix the two: ours goes by another name, and is compiled in.
#define tinygltf lambent_tinygltf
#include <tiny_gltf.h>
