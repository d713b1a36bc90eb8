// SPDX-License-Identifier: Apache-2.0
// lambent bake: a field that has settled, in a file.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "bake/checkpoint.h"
#include "core/stopwatch.h"
#include "field/field_access.h"
#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/field_options.h"
#include "lambent/field_updates.h"
#include "lambent/help.h"
#include "lambent/job.h"
#include "lambent/memory_check.h"
#include "lambent/output.h"
#include "lambent/progress_bar.h"
#include "lambent/scene_options.h"
#include "lambent/step.h"
#include "lambent/threads.h"
#include "lambent/validators.h"
#include "lambent/words.h"
#include "lambent/world.h"

namespace lambent::cli {
namespace {

struct BakeOptions {
  SceneOptions scene;
  FieldOptions field;
  std::string output;
  std::string stats;
  std::optional<float> time_s;  // none: the rest pose
  int updates = 0;              // 0: until the light has settled
  int bounces = -1;             // -1: all
  std::uint32_t seed = 1;
  int threads = 0;  // 0: all
  std::string checkpoint;
  double every_s = 600.0;
};

// Time between two lines of progress where stderr is not a terminal [s].
constexpr double kSecondsBetweenLines = 10.0;

Expected<void> check(const BakeOptions& options) {
  if (const auto fine = check_own_output(options.output, "a field"); !fine) return fine;
  if (!options.stats.empty()) {
    if (const auto fine = check_place(options.stats); !fine) return fine;
  }
  if (!options.checkpoint.empty()) {
    const auto fine = check_own_output(options.checkpoint, "a checkpoint");
    if (!fine) return fine;
  }
  CommandFiles files;
  files.reads_scene(options.scene.file);
  files.reads(options.scene.light.environment, "--environment");
  files.writes(options.output, "-o");
  files.writes(options.stats, "--stats");
  files.writes(options.checkpoint, "--checkpoint");
  return files.check();
}

void tell_baked(const BakeOptions& options, const IrradianceField& field,
                const FieldProgress& reached) {
  const char* how = options.updates > 0 ? "made" : reached.settled ? "settled" : "not settled";
  std::array<char, 128> text;
  std::snprintf(text.data(), text.size(),
                "%s after %s, the last of which changed the light by %.3g %%", how,
                count_text(static_cast<std::size_t>(reached.updates), "update").c_str(),
                100.0 * reached.change);
  tell_written(options.output, std::to_string(field.probes()) + " probes", text.data());
}

/// The state of a bake.
struct Baking {
  Scene scene;
  std::unique_ptr<World> world;
  std::optional<IrradianceField> field;
  UpdateRequest request;
};

/// Reads the scene, and makes the field to be baked. Every process does so for itself.
Expected<void> prepare(const BakeOptions& options, const Job& job, Baking& baking) {
  // Only the first process writes files
  if (job.leads()) {
    if (const auto fine = check(options); !fine) return fine;
  }
  // Report wrong options before the scene is read
  if (const auto fine = field_settings(options.field, {}, options.seed, options.bounces); !fine) {
    return tl::unexpected(fine.error());
  }
  begin_step("reading the scene");
  Expected<OpenedScene> opened = open_lit_scene(options.scene);
  if (!opened) return tl::unexpected(opened.error());
  baking.scene = std::move(opened->scene);
  if (options.time_s) {
    if (baking.scene.animations.empty()) {
      return fail("--time", "", "the scene has no animation that can be played");
    }
    animate(baking.scene, -1, *options.time_s);
  }
  begin_step("preparing the scene for rays");
  baking.world = std::make_unique<World>(baking.scene);
  World& world = *baking.world;
  const Expected<View> view = choose_view(options.scene, world, FirstViewSettings().aspect);
  if (!view) return tl::unexpected(view.error());
  const auto light =
      add_first_light(options.scene.light, view->camera, opened->sky_dome, baking.scene, world);
  if (!light) return tl::unexpected(light.error());
  tell("light: " + light->description);
  const auto settings = field_settings(options.field, baking.scene, options.seed, options.bounces);
  if (!settings) return tl::unexpected(settings.error());
  begin_step("updating the field");
  Expected<IrradianceField> field = make_field(*settings, options.field, world, view->camera, 1,
                                               {job.ranks.count(), job.on_this_machine});
  if (!field) return tl::unexpected(field.error());
  baking.field.emplace(std::move(*field));
  baking.request = {0, 0.0, glm::vec3(view->camera.world_from_view[3])};
  return {};
}

/// Fails where the scenes or options of processes differ.
Expected<void> check_alike(const Job& job, const Baking& baking) {
  const std::vector<std::uint32_t> each =
      gather_each(job.ranks, bake_identity(*baking.field, *baking.world, baking.request.viewer_ws));
  const auto other = std::find_if(each.begin(), each.end(),
                                  [&](std::uint32_t identity) { return identity != each.front(); });
  if (other == each.end()) return {};
  return fail("", "rank " + std::to_string(other - each.begin()),
              "has another scene than rank 0, or other options");
}

/// Resumes an interrupted bake, if there is a checkpoint. The first process decides whether there
/// is one.
Expected<void> resume(const BakeOptions& options, const Job& job, Baking& baking) {
  if (options.checkpoint.empty()) return {};
  std::error_code ignored;
  const bool here = job.leads() && std::filesystem::exists(options.checkpoint, ignored);
  if (gather_each<std::uint8_t>(job.ranks, here ? 1 : 0).front() == 0) return {};
  begin_step("reading the checkpoint");
  Expected<Checkpoint> read =
      read_checkpoint(options.checkpoint, *baking.world, baking.request.viewer_ws, *baking.field);
  Expected<void> fine;
  if (!read) fine = tl::unexpected(read.error());
  if (read && options.updates > 0 && read->updates() > options.updates) {
    fine = fail(options.checkpoint, "",
                "has had " + std::to_string(read->updates()) + " updates, more than --updates");
  }
  if (const auto all_fine = agree(job, fine); !all_fine) return all_fine;
  begin_step("updating the field");
  resume_from(*read, *baking.world, baking.request.viewer_ws, *baking.field);
  tell("going on from " + options.checkpoint + ", after " +
       std::to_string(baking.field->updates()) + " updates");
  return {};
}

/// Returns the function that is called after each update: it writes checkpoints, and without a
/// terminal, prints lines of progress.
std::function<void(const FieldProgress&)> between_updates(const BakeOptions& options,
                                                          const Job& job, const Baking& baking,
                                                          bool tells_lines) {
  auto since_checkpoint = std::make_shared<Stopwatch>();
  auto since_line = std::make_shared<Stopwatch>();
  auto seconds = std::make_shared<std::array<double, 2>>();
  return [&options, &job, &baking, tells_lines, since_checkpoint, since_line,
          seconds](const FieldProgress& reached) {
    constexpr double kMsPerSecond = 1000.0;
    auto& [unsaved, untold] = *seconds;
    untold += since_line->lap() / kMsPerSecond;
    if (tells_lines && untold >= kSecondsBetweenLines) {
      untold = 0.0;
      std::array<char, 96> text;
      std::snprintf(text.data(), text.size(), "update %d changed the light by %.3g %%",
                    reached.updates, 100.0 * reached.change);
      tell(text.data());
    }
    if (options.checkpoint.empty()) return;
    unsaved += since_checkpoint->lap() / kMsPerSecond;
    // The first process's clock decides
    const bool due = unsaved >= options.every_s;
    if (gather_each<std::uint8_t>(job.ranks, due ? 1 : 0).front() == 0) return;
    unsaved = 0.0;
    // If this fails, so does the following call, which reports the cause
    if (job.leads()) (void)make_folders(options.checkpoint);
    const auto saved =
        save_checkpoint(options.checkpoint, *baking.field, *baking.world, baking.request.viewer_ws);
    // The bake can still finish without a checkpoint
    if (!saved) warn(saved.error().message());
  };
}

/// Writes the baked field and the other requested outputs.
Expected<void> write(const BakeOptions& options, const Job& job, const Baking& baking,
                     const FieldProgress& reached, const nlohmann::ordered_json& stats) {
  begin_step("writing the field");
  Expected<void> made;
  if (job.leads()) made = make_folders(options.output);
  if (const auto all_made = agree(job, made); !all_made) return all_made;
  const auto saved = save_field(options.output, *baking.field, *baking.world);
  if (!saved || !job.leads()) return saved;
  if (!options.checkpoint.empty()) {
    std::error_code ignored;
    std::filesystem::remove(options.checkpoint, ignored);
  }
  if (!options.stats.empty()) {
    if (const auto told = write_statistics(options.stats, stats); !told) return told;
  }
  tell_baked(options, *baking.field, reached);
  return {};
}

/// The peak memory of this process so far [bytes].
std::uint64_t peak_memory() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // ru_maxrss is in KiB
}

Expected<void> bake(const BakeOptions& options, const Job& job) {
  const ThreadLimit limit(options.threads);
  Baking baking;
  if (const auto fine = agree(job, prepare(options, job, baking)); !fine) return fine;
  if (const auto fine = check_alike(job, baking); !fine) return fine;
  share_work(*baking.field, job.ranks);
  if (const auto fine = resume(options, job, baking); !fine) return fine;

  nlohmann::ordered_json stats;
  stats["triangles"] = triangle_count(baking.scene);
  stats["build_ms"] = baking.world->build_ms();
  stats["ranks"] = job.ranks.count();
  FieldProgress reached;
  {
    const bool many = job.ranks.count() > 1;
    const ProgressFn progress = many ? terminal_progress() : stderr_progress();
    const bool tells_lines = many && !progress;
    reached =
        bake_field(*baking.world, baking.request,
                   {options.updates, progress, between_updates(options, job, baking, tells_lines)},
                   *baking.field, stats);
  }
  stats["settled"] = reached.settled;
  stats["surfel_bytes"] = sum_over(job.ranks, baking.field->surfel_bytes());
  const auto peaks = gather_each(job.ranks, peak_memory());
  stats["peak_memory_of_a_rank_bytes"] = *std::max_element(peaks.begin(), peaks.end());
  return agree(job, write(options, job, baking, reached, stats));
}

}  // namespace

void add_bake(CLI::App& app, Run& run) {
  auto o = std::make_shared<BakeOptions>();
  CLI::App* command = app.add_subcommand("bake", "Compute a scene's field, and write it to a file");
  command->group(kFieldGroup);
  command->option_defaults()->group(kMainGroup);
  command->add_option("-o,--output", o->output, "The field file to write, such as a.field")
      ->required()
      ->check(file_name())
      ->type_name("FILE");
  command->add_option("--updates", o->updates, "Update so often (until the light has settled)")
      ->check(whole_number(1, kMaxUpdates))
      ->type_name("N");
  command->add_option("--time", o->time_s, "Time of the scene's animation [s]")
      ->check(number(-kMaxTime, kMaxTime))
      ->type_name("S");
  command->add_option("--bounces", o->bounces, "Bounces of indirect light (all of them)")
      ->check(whole_number(0, kMaxBounces))
      ->type_name("N");
  command->add_option("--seed", o->seed, "Of all random numbers")
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--threads", o->threads, "Threads to use (all)")
      ->check(whole_number(1, kMaxThreads))
      ->type_name("N");
  command->add_option("--stats", o->stats, "Write times and counts to this .json file")
      ->check(file_name())
      ->type_name("FILE");
  command
      ->add_option("--checkpoint", o->checkpoint,
                   "Keep what is done so far in this file, and go on from it if it is there")
      ->type_name("FILE");
  command->add_option("--every", o->every_s, "Seconds between checkpoints")
      ->needs("--checkpoint")
      ->check(number(0.0, kMaxTime))
      ->capture_default_str()
      ->type_name("S");
  add_scene_options(*command, o->scene);
  add_field_options(*command, o->field);
  command->callback(
      [o, &run] { run = [o] { return run_job([o](const Job& job) { return bake(*o, job); }); }; });
}

}  // namespace lambent::cli
