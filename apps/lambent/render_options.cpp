// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "lambent/parse.h"
#include "lambent/render_output.h"
#include "lambent/threads.h"

namespace lambent::cli {
namespace {

// Typing errors are caught before they cost days: more samples leave no noise to see.
constexpr int kMaxSamples = 1 << 20;

// One probe's fewest rays; more rays than a probe has for as many probes as there can be.
constexpr std::uint64_t kMinRayBudget = 32;
constexpr std::uint64_t kMaxRayBudget = 1ull << 32;
// From what a clock can tell to an hour [ms].
constexpr double kMinTimeBudget = 0.1;
constexpr double kMaxTimeBudget = 3.6e6;

// A day at 24 frames a second has two million: more is a typing error.
constexpr int kMaxFrames = 10'000'000;
constexpr float kMaxFps = 1e6f;

void add_sequence_options(CLI::App& command, RenderOptions& o) {
  command.add_option("--time", o.time_s,
                     "Time of the scene's animation [s]; of a sequence's start");
  command.add_option("--animation", o.animation,
                     "Which animation of the scene plays, by index or name (all at once)");
  command.add_option("--frames", o.frames, "Write a sequence of so many pictures")
      ->check(CLI::Range(1, kMaxFrames));
  o.fps_option = command.add_option("--fps", o.fps, "Frames of a sequence a second")
                     ->check([](const std::string& text) {
                       float fps = 0.0f;
                       const bool fine =
                           CLI::detail::lexical_cast(text, fps) && fps > 0.0f && fps <= kMaxFps;
                       return fine ? std::string() : "'" + text + "' is not a number above 0";
                     })
                     ->capture_default_str();
}

void add_light_options(CLI::App& command, RenderOptions& o) {
  const std::size_t others = command.get_options().size();
  command
      .add_option("--gather", o.gather_rays,
                  "Rays a sample gathers indirect light with (0: look the field up)")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  add_field_options(command, o.field);
  command.add_option("--field", o.field_file, "Start from the field in this file");
  command.add_option("--updates", o.updates, "Updates of the field before the frame")
      ->check(CLI::Range(0, kMaxUpdates))
      ->capture_default_str();
  command.add_flag("--converge", o.converge, "Update until the field has settled")
      ->excludes("--updates");
  CLI::Option* const frame_updates =
      command
          .add_option("--frame-updates", o.frame_updates,
                      "Updates of the field before each frame of a sequence after the first")
          ->check(CLI::Range(0, kMaxUpdates))
          ->capture_default_str();
  o.of_running_fields.push_back(frame_updates);
  o.of_sequences.push_back(
      command
          .add_option("--ray-budget", o.ray_budget,
                      "Rays an update after the first frame's may trace (as many as it takes)")
          ->check(CLI::Range(kMinRayBudget, kMaxRayBudget)));
  o.of_sequences.push_back(
      command
          .add_option("--time-budget", o.time_budget_ms,
                      "Time it may take [ms], which the field learns to keep (as long as it takes)")
          ->check(CLI::Range(kMinTimeBudget, kMaxTimeBudget)));
  o.of_running_fields.insert(o.of_running_fields.end(), o.of_sequences.begin(),
                             o.of_sequences.end());
  command
      .add_option("--show-probes", o.show_probes,
                  "Draw the probes as spheres of their irradiance, distance, state or age")
      ->check(CLI::IsMember({"irradiance", "distance", "state", "age"}));
  const std::vector<CLI::Option*> all = command.get_options();
  o.of_the_field.assign(all.begin() + static_cast<std::ptrdiff_t>(others), all.end());
}

}  // namespace

bool uses_field(const RenderOptions& options) {
  return options.method == "field" || options.method == "rsm+field";
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
  if (const auto fine = check_rsm_use(options.rsm, options.method, options.bounces,
                                      options.gather_rays, options.converge);
      !fine) {
    return fine;
  }
  if (uses_field(options)) {
    // What is wrong with the volumes is told before the scene is read
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
  if (options.time_s && !std::isfinite(*options.time_s)) {
    return fail("--time", "", "is not a finite number of seconds");
  }
  if (!options.animation.empty() && !options.time_s && options.frames == 0) {
    return fail("--animation", "", "goes with --time or --frames");
  }
  for (const CLI::Option* option : options.of_sequences) {
    if (options.frames > 0 || option->count() == 0) continue;
    return fail(option->get_name(), "", "goes with --frames");
  }
  if (options.frames == 0 && options.fps_option->count() > 0) {
    return fail("--fps", "", "goes with --frames");
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
  add_stage_options(command, o.stage);
  command
      .add_option(
          "-o,--output", o.output,
          "The .exr (linear) or .png file to write; in a sequence, #### stands for the frame's "
          "number (without it, out.png becomes out.0000.png, ...)")
      ->required();
  command.add_option("--method", o.method, "field, rsm, rsm+field, direct or reference")
      ->check(CLI::IsMember({"field", "rsm", "rsm+field", "direct", "reference"}))
      ->capture_default_str();
  add_backend_options(command, o.backend);
  command.add_option("--size", o.size, "WxH [pixels]")->capture_default_str();
  command
      .add_option("--samples", o.samples,
                  "Rays or paths a pixel (field and direct: 4, reference: 64)")
      ->check(CLI::Range(1, kMaxSamples));
  command.add_option("--bounces", o.bounces, "Bounces of indirect light (all of them)")
      ->check(CLI::Range(0, kMaxBounces));
  command.add_option("--seed", o.seed, "Of all random numbers")->capture_default_str();
  command.add_option("--threads", o.threads, "Threads to use (all)")
      ->check(CLI::Range(1, kMaxThreads));
  command.add_flag("--layers", o.layers, "Write every layer of the frame, .exr only");
  command.add_option("--stats", o.stats, "Write times and counts to this .json file");
  command
      .add_option("--exposure", o.exposure,
                  "Of a .png, in stops, or auto (a sequence's first frame decides)")
      ->capture_default_str();
  command.add_option("--tone-map", o.tone_map, "Of a .png: aces, neutral or linear")
      ->check(CLI::IsMember({"aces", "neutral", "linear"}))
      ->capture_default_str();
  command
      .add_option("--verify", o.verify_samples,
                  "Also path-trace so many samples a pixel and print the error")
      ->check(CLI::Range(2, kMaxSamples));
  add_rsm_options(command, o.rsm);
  add_sequence_options(command, o);
  add_light_options(command, o);
}

}  // namespace lambent::cli
