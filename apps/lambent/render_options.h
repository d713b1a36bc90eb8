// SPDX-License-Identifier: Apache-2.0
// The arguments of `lambent render`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lambent/backend.h"
#include "lambent/error.h"
#include "lambent/field_options.h"
#include "lambent/render_rsm.h"
#include "lambent/scene_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lambent::cli {

/// Maximum of --samples. It catches typing errors before they cost days; with more samples no noise
/// is visible anyway.
inline constexpr int kMaxSamples = 1 << 20;

/// The options of `lambent render`.
struct RenderOptions {
  SceneOptions scene;
  std::string output;  // empty until render chooses: beside the scene
  std::string method = "field";
  BackendOptions backend;
  std::string size = "1280x720";
  std::string quality;               // empty: depends on the other options
  std::vector<std::string> without;  // passes
  int samples = 0;                   // 0: the quality's, or the reference's default
  int most_samples = 0;              // 0: the quality's
  int gather_rays = -1;              // -1: the quality's
  int glossy_rows = -1;              // -1: the quality's
  int coat_rays = 0;                 // 0: the quality's
  int froxel_pixels = 0;             // 0: the quality's
  int bounces = -1;                  // -1: all
  std::uint32_t seed = 1;
  int threads = 0;  // 0: all
  bool layers = false;
  std::string stats;
  std::string exposure = "auto";
  std::string tone_map = "aces";
  int verify_samples = 0;

  RsmOptions rsm;

  std::optional<float> time_s;  // none: the rest pose, or the start of a sequence
  std::string animation;        // by index or name; empty: all at once
  int frames = 0;               // 0: one picture
  float fps = 24.0f;
  std::uint64_t ray_budget = 0;  // of an update between frames; 0: no bound
  double time_budget_ms = 0.0;   // of an update between frames [ms]; 0: no bound
  int frame_updates = 1;         // of the field, before each frame after the first

  FieldOptions field;
  std::string field_file;  // to start from; empty: none
  int updates = -1;        // -1: the quality's
  bool converge = false;
  std::string show_probes;                            // the aspect to show; empty: none
  std::vector<const CLI::Option*> of_running_fields;  // options only for a field shared by frames
  std::vector<const CLI::Option*> of_sequences;       // options only for sequences
  std::vector<const CLI::Option*> of_the_field;       // options only for methods with a field
};

/// Whether the method looks a field up ("field", "rsm+field").
bool uses_field(const RenderOptions& options);

/// Whether the layer "motion" is written: for sequences whose layers are written.
bool keeps_motion(const RenderOptions& options);

/// Declares all options on `command`; `options` must outlive it.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Fails on options that are valid individually, but not together.
Expected<void> check_options(const RenderOptions& options);

}  // namespace lambent::cli
