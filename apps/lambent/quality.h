// SPDX-License-Identifier: Apache-2.0
// The settings that result from --quality, --without, --samples and --gather.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "lambent/error.h"
#include "lambent/render_options.h"
#include "lambent/renderer.h"

namespace CLI {
class App;
}  // namespace CLI

namespace lambent::cli {

/// Frames of a sequence, or of a server, over which light is averaged: each counts a tenth.
inline constexpr int kAveragedFrames = 10;

/// Declares --quality, --without and --samples.
void add_quality_options(CLI::App& command, RenderOptions& options);

/// The quality of a name that --quality takes.
Quality quality_from_name(const std::string& name);

/// Settings of a picture of this size: those of the quality, except where other options override
/// them.
FrameSettings frame_settings(const RenderOptions& options, const glm::ivec2& size);

/// The grid of a picture's field where it may have finer volumes around the camera: none where the
/// options, or the scene's author, say where probes stand.
std::optional<FieldGrid> refinable_grid(const RenderOptions& options, const World& world,
                                        const Camera& camera);

/// Settings of the field that lights a picture: those of the quality, except where other options
/// override them. A refinable grid gets finer volumes: in `path_boxes`, the near_box() of places
/// along the path of a camera that moves, or, where there are none, around this camera.
Expected<FieldSettings> picture_field_settings(const RenderOptions& options, const World& world,
                                               const Camera& camera,
                                               std::span<const Bounds> path_boxes);

/// Whether the field is updated until its light is calm, not a fixed number of times.
bool wants_calm_field(const RenderOptions& options);

/// Whether a sequence's frames are anti-aliased over time.
bool uses_taa(const RenderOptions& options);

/// Whether some of its light is filtered.
bool is_filtered(const RenderOptions& options);

/// Fails on options that are valid individually, but not together.
Expected<void> check_quality(const RenderOptions& options);

/// Whether --without names a pass.
bool leaves_out(const RenderOptions& options, const char* pass);

}  // namespace lambent::cli
