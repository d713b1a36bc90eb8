// SPDX-License-Identifier: Apache-2.0
// Everything that is public, and which version of it this is.
#pragma once

/// The version, in numbers that the preprocessor can compare. The build reads it here, too.
#define LAMBENT_VERSION_MAJOR 0
#define LAMBENT_VERSION_MINOR 1
#define LAMBENT_VERSION_PATCH 0

#include "lambent/error.h"
#include "lambent/field.h"
#include "lambent/image.h"
#include "lambent/progress.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "lambent/scene.h"
#include "lambent/world.h"
