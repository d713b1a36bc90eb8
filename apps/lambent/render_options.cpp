// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_options.h"

#include <CLI/CLI.hpp>
#include <limits>

#include "lambent/help.h"
#include "lambent/parse.h"
#include "lambent/quality.h"
#include "lambent/render_output.h"
#include "lambent/threads.h"
#include "lambent/validators.h"

namespace lambent::cli {
namespace {

// Range of --ray-budget: from the least rays of one probe to more than all rays of the largest
// field.
constexpr std::int64_t kMinRayBudget = 32;
constexpr std::int64_t kMaxRayBudget = std::int64_t{1} << 32;
// From the resolution of clocks to an hour [ms].
constexpr double kMinTimeBudget = 0.1;
constexpr double kMaxTimeBudget = 3.6e6;

// A day at 24 frames a second has two million: more is a typing error.
constexpr int kMaxFrames = 10'000'000;
constexpr double kMaxFps = 1e6;

void add_sequence_options(CLI::App& command, RenderOptions& o) {
  command.option_defaults()->group("Motion");
  command
      .add_option("--time", o.time_s, "Time of the scene's animation [s]; of a sequence's start")
      ->check(number(-kMaxTime, kMaxTime))
      ->type_name("S");
  command
      .add_option("--animation", o.animation,
                  "Which animation of the scene plays, by index or name (all at once)")
      ->type_name("A");
  command.add_option("--frames", o.frames, "Write a sequence of so many pictures")
      ->check(whole_number(1, kMaxFrames))
      ->type_name("N");
  const auto of_sequences = [&o](CLI::Option* option) {
    o.of_sequences.push_back(option);
    return option;
  };
  of_sequences(command.add_option("--fps", o.fps, "Frames of a sequence a second"))
      ->check(number_above_zero(kMaxFps))
      ->capture_default_str()
      ->type_name("F");
  const std::size_t others = command.get_options().size();
  of_sequences(command.add_option("--frame-updates", o.frame_updates,
                                  "Updates of the field before each frame after the first"))
      ->check(whole_number(0, kMaxUpdates))
      ->capture_default_str()
      ->type_name("N");
  of_sequences(
      command.add_option("--ray-budget", o.ray_budget,
                         "Rays an update after the first frame's may trace (as many as it takes)"))
      ->check(whole_number(kMinRayBudget, kMaxRayBudget))
      ->type_name("N");
  of_sequences(command.add_option(
                   "--time-budget", o.time_budget_ms,
                   "Time it may take [ms], which the field learns to keep (as long as it takes)"))
      ->check(number(kMinTimeBudget, kMaxTimeBudget))
      ->type_name("MS");
  const std::vector<CLI::Option*> all = command.get_options();
  o.of_running_fields.assign(all.begin() + static_cast<std::ptrdiff_t>(others), all.end());
  o.of_the_field = o.of_running_fields;
}

void add_field_render_options(CLI::App& command, RenderOptions& o) {
  const std::size_t others = command.get_options().size();
  add_field_options(command, o.field);
  command
      .add_option("--gather", o.gather_rays,
                  "Rays a sample gathers indirect light with, up to 4096; 0: look the field up "
                  "(the quality's)")
      ->check(whole_number(0, 4096))
      ->type_name("N");
  command
      .add_option("--glossy-rows", o.glossy_rows,
                  "Trace reflections in every Nth row of pixels, up to 8; 0: reflect the field "
                  "(the quality's)")
      ->check(whole_number(0, 8))
      ->type_name("N");
  command
      .add_option("--coat-rays", o.coat_rays,
                  "Rays of reflections at pixels of thin or curved metal, up to 64 "
                  "(the quality's)")
      ->check(whole_number(1, 64))
      ->type_name("N");
  command.add_option("--field", o.field_file, "Start from the field in this file, of lambent bake")
      ->type_name("FILE");
  command
      .add_option("--updates", o.updates,
                  "Updates of the field before the frame (8; of pictures of --quality high up to "
                  "80 or 8 million rays, until its standard error is below 2.5 %, 4 % with many "
                  "probes)")
      ->check(whole_number(0, kMaxUpdates))
      ->type_name("N");
  command.add_flag("--converge", o.converge, "Or update until the field has settled")
      ->excludes("--updates");
  command
      .add_option("--show-probes", o.show_probes,
                  "Draw the probes as spheres of their irradiance, distance, state or age")
      ->check(one_of({"irradiance", "distance", "state", "age"}))
      ->type_name("A");
  const std::vector<CLI::Option*> all = command.get_options();
  o.of_the_field.insert(o.of_the_field.end(), all.begin() + static_cast<std::ptrdiff_t>(others),
                        all.end());
}

void add_output_options(CLI::App& command, RenderOptions& o) {
  command.option_defaults()->group("Display, of .png and .jpg");
  command
      .add_option("--exposure", o.exposure, "In stops, or auto (a sequence's first frame decides)")
      ->capture_default_str()
      ->type_name("E");
  command.add_option("--tone-map", o.tone_map, "aces, neutral or linear")
      ->check(one_of({"aces", "neutral", "linear"}))
      ->capture_default_str()
      ->type_name("T");
  command.option_defaults()->group("Layers and measurements");
  command.add_flag("--layers", o.layers, "Write every layer of the frame, .exr only");
  command.add_option("--stats", o.stats, "Write times and counts to this .json file")
      ->check(file_name())
      ->type_name("FILE");
  command
      .add_option("--verify", o.verify_samples,
                  "Also path-trace so many samples a pixel, and print the error")
      ->check(whole_number(2, kMaxSamples))
      ->type_name("N");
}

void add_machine_options(CLI::App& command, RenderOptions& o) {
  command.option_defaults()->group("Quality and machine");
  add_quality_options(command, o);
  command.add_option("--bounces", o.bounces, "Bounces of indirect light (all of them)")
      ->check(whole_number(0, kMaxBounces))
      ->type_name("N");
  command.add_option("--seed", o.seed, "Of all random numbers")
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()))
      ->capture_default_str()
      ->type_name("N");
  command.add_option("--threads", o.threads, "Threads to use (all)")
      ->check(whole_number(1, kMaxThreads))
      ->type_name("N");
  add_backend_options(command, o.backend);
}

}  // namespace

bool uses_field(const RenderOptions& options) {
  return options.method == "field" || options.method == "rsm+field";
}

bool keeps_motion(const RenderOptions& options) {
  return options.layers && options.frames > 0 && options.method != "reference";
}

Expected<void> check_options(const RenderOptions& options) {
  if (const auto exposure = parse_exposure(options.exposure); !exposure) {
    return tl::unexpected(exposure.error());
  }
  if (const auto fine = check_backend(options.backend); !fine) return fine;
  if (options.backend.name != "cpu" && options.method == "reference") {
    return fail("--backend", "", "--method reference is traced on the processor alone");
  }
  for (const CLI::Option* option : options.of_the_field) {
    if (uses_field(options) || option->count() == 0) continue;
    return fail(option->get_name(), "", "goes with --method field and rsm+field alone");
  }
  if (const auto fine = check_quality(options); !fine) return fine;
  if (const auto fine = check_rsm_use(options.rsm, options.method, options.bounces,
                                      options.gather_rays, options.converge);
      !fine) {
    return fine;
  }
  if (uses_field(options)) {
    // Report wrong volumes before the scene is read
    const auto fine = field_settings(options.field, {}, options.seed, options.bounces);
    if (!fine) return tl::unexpected(fine.error());
  }
  if (options.method == "rsm+field" && options.field.settings.cascades > 0) {
    return fail("--cascades", "", "go with --method field alone: its two fields differ in them");
  }
  if (options.method == "rsm+field" && !options.field_file.empty()) {
    return fail("--field", "", "goes with --method field alone: a file holds no light by bounces");
  }
  if (options.method == "rsm+field" && options.frames > 0) {
    for (const CLI::Option* option : options.of_running_fields) {
      if (option->count() == 0) continue;
      return fail(option->get_name(), "",
                  "goes with --method field alone: each frame of rsm+field has fields of its own");
    }
  }
  for (const CLI::Option* option : options.field.of_shape) {
    if (options.field_file.empty() || option->count() == 0) continue;
    return fail(option->get_name(), "", "is what the file of --field decides");
  }
  if (options.updates == 0 && options.field_file.empty()) {
    return fail("--updates", "", "without any, the field's light must come from --field");
  }
  if (!options.show_probes.empty() && options.verify_samples > 0) {
    return fail("--verify", "", "compares pictures without --show-probes");
  }
  if (!options.animation.empty() && !options.time_s && options.frames == 0) {
    return fail("--animation", "", "goes with --time or --frames");
  }
  for (const CLI::Option* option : options.of_sequences) {
    if (options.frames > 0 || option->count() == 0) continue;
    return fail(option->get_name(), "", "goes with --frames");
  }
  if (options.frames > 0 && options.verify_samples > 0) {
    return fail("--verify", "", "goes with one picture, not with --frames");
  }
  if (options.method == "direct" && options.bounces > 0) {
    return fail("--bounces", "", "--method direct has none");
  }
  return {};
}

void add_render_options(CLI::App& command, RenderOptions& o) {
  command.option_defaults()->group(kMainGroup);
  command
      .add_option("-o,--output", o.output,
                  "The .png, .jpg or .exr (linear, 32-bit float) to write (SCENE.png beside the "
                  "scene). In a sequence #### stands for the frame's number; without it a.png "
                  "becomes a.0000.png, ...")
      ->check(file_name())
      ->type_name("FILE");
  command.add_option("--size", o.size, "Pixels; or a name: 480p, 720p, 1080p, 1440p, 4k, 8k")
      ->capture_default_str()
      ->type_name("WxH");
  add_scene_and_view_options(command, o.scene);
  for (const char* name : {"--camera", "--light"}) command.get_option(name)->group(kMainGroup);
  command.option_defaults()->group(kMainGroup);
  command
      .add_option("--method", o.method,
                  "field: all bounces from an irradiance field; rsm: one bounce from shadow maps; "
                  "rsm+field; direct: none; reference: path tracer")
      ->check(one_of({"field", "rsm", "rsm+field", "direct", "reference"}))
      ->capture_default_str()
      ->type_name("M");
  add_machine_options(command, o);
  add_output_options(command, o);
  add_sequence_options(command, o);
  add_field_render_options(command, o);
  add_rsm_options(command, o.rsm);
}

}  // namespace lambent::cli
