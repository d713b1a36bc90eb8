// SPDX-License-Identifier: Apache-2.0
// Includes every public header, and defines the version of the library.
#pragma once

/// The version, as numbers that the preprocessor can compare. The build reads them from here.
#define LAMBENT_VERSION_MAJOR 0
#define LAMBENT_VERSION_MINOR 1
#define LAMBENT_VERSION_PATCH 0

#include "lambent/animation.h"
#include "lambent/denoise.h"
#include "lambent/error.h"
#include "lambent/field.h"
#include "lambent/first_picture.h"
#include "lambent/fog.h"
#include "lambent/image.h"
#include "lambent/pass_time.h"
#include "lambent/progress.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "lambent/scene.h"
#include "lambent/stream.h"
#include "lambent/vulkan.h"
#include "lambent/vulkan_device.h"
#include "lambent/vulkan_field.h"
#include "lambent/world.h"
