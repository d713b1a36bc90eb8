// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lambent/error.h"
#include "lambent/frame_renderer.h"
#include "lambent/sequence_survey.h"

namespace lambent::cli {

/// Renders the frames of the options, for each of which the scene is posed. Statistics of each
/// frame are added to the list stats["frames"], also of those before a failure. The first interrupt
/// (Ctrl-C) ends the sequence after the current frame, the second one at once. `view` is that of
/// the first frame.
Expected<void> render_sequence(const RenderOptions& options, const PosedScene& posed,
                               const View& view, FrameRenderer& renderer,
                               nlohmann::ordered_json& stats);

}  // namespace lambent::cli
