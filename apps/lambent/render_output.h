// SPDX-License-Identifier: Apache-2.0
// The files that `lambent render` writes.
#pragma once

#include <optional>
#include <string>

#include "lambent/error.h"
#include "lambent/image.h"
#include "lambent/render_options.h"

namespace lambent::cli {

/// Fails early on outputs that could not be written after minutes of work.
Expected<void> check_outputs(const RenderOptions& options);

/// Where a frame of a sequence goes: its number, of four digits or more, replaces the #### in the
/// pattern's file name; where there is none, it stands before the ending.
std::string frame_path(const std::string& pattern, int frame);

/// Writes a picture as the options say. `stops` is the exposure of a .png or .jpg; none: it is set
/// to what the options ask for, so that the pictures of a sequence share one.
Expected<void> write_output(const RenderOptions& options, const LayeredImage& image,
                            const std::string& path, std::optional<float>& stops);

}  // namespace lambent::cli
