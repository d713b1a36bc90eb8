// SPDX-License-Identifier: Apache-2.0
// The Vulkan headers, without prototypes: a library that is linked into an engine must not define
// symbols of Vulkan's names, and must start where there is no loader. Vulkan's functions are
// members of Functions.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan_core.h>
