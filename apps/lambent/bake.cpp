// SPDX-License-Identifier: Apache-2.0
// lambent bake: a field that has settled, in a file.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/field_options.h"
#include "lambent/help.h"
#include "lambent/memory_check.h"
#include "lambent/output.h"
#include "lambent/progress_bar.h"
#include "lambent/stage.h"
#include "lambent/step.h"
#include "lambent/threads.h"
#include "lambent/validators.h"
#include "lambent/world.h"

namespace lambent::cli {
namespace {

struct Options {
  StageOptions stage;
  FieldOptions field;
  std::string output;
  std::string stats;
  std::optional<float> time_s;  // none: the rest pose
  int updates = 0;              // 0: until the light has settled
  int bounces = -1;             // -1: all
  std::uint32_t seed = 1;
  int threads = 0;  // 0: all
};

Expected<void> check(const Options& options) {
  if (const auto fine = check_own_output(options.output, "a field"); !fine) return fine;
  if (!options.stats.empty()) {
    if (const auto fine = check_place(options.stats); !fine) return fine;
  }
  CommandFiles files;
  files.reads_scene(options.stage.scene);
  files.reads(options.stage.light.environment, "--environment");
  files.writes(options.output, "-o");
  files.writes(options.stats, "--stats");
  return files.check();
}

void tell_baked(const Options& options, const IrradianceField& field,
                const FieldProgress& reached) {
  const char* how = options.updates > 0 ? "made" : reached.settled ? "settled" : "not settled";
  std::array<char, 128> text;
  std::snprintf(text.data(), text.size(),
                "%s after %d updates, the last of which changed the light by %.3g %%", how,
                reached.updates, 100.0 * reached.change);
  tell_written(options.output, std::to_string(field.probes()) + " probes", text.data());
}

Expected<void> bake(const Options& options) {
  if (const auto fine = check(options); !fine) return fine;
  // What is wrong with the options is told before the scene is read
  if (const auto fine = field_settings(options.field, {}, options.seed, options.bounces); !fine) {
    return tl::unexpected(fine.error());
  }
  const ThreadLimit limit(options.threads);

  begin_step("reading the scene");
  Expected<Scene> scene = open_stage(options.stage);
  if (!scene) return tl::unexpected(scene.error());
  if (options.time_s) {
    if (scene->animations.empty()) {
      return fail("--time", "", "the scene has no animation that can be played");
    }
    animate(*scene, -1, *options.time_s);
  }
  begin_step("preparing the scene for rays");
  World world(*scene);
  const Expected<View> view = choose_view(options.stage, world, FirstViewSettings().aspect);
  if (!view) return tl::unexpected(view.error());
  const auto light = add_first_light(options.stage.light, view->camera, *scene, world);
  if (!light) return tl::unexpected(light.error());
  tell("light: " + *light);
  const auto settings = field_settings(options.field, *scene, options.seed, options.bounces);
  if (!settings) return tl::unexpected(settings.error());
  begin_step("updating the field");
  Expected<IrradianceField> field = make_field(*settings, options.field, world, view->camera, 1);
  if (!field) return tl::unexpected(field.error());

  nlohmann::ordered_json stats;
  stats["triangles"] = triangle_count(*scene);
  stats["build_ms"] = world.build_ms();
  FieldProgress reached;
  const UpdateRequest request{0, 0.0, glm::vec3(view->camera.world_from_view[3])};
  {
    const ProgressFn progress = terminal_progress();
    reached = options.updates > 0
                  ? update_field(world, options.updates, request, *field, progress, stats)
                  : settle_field(world, request, *field, progress, stats);
  }
  stats["settled"] = reached.settled;
  begin_step("writing the field");
  if (const auto made = make_folders(options.output); !made) return made;
  if (const auto saved = save_field(options.output, *field, world); !saved) return saved;
  if (!options.stats.empty()) {
    if (const auto told = write_statistics(options.stats, stats); !told) return told;
  }
  tell_baked(options, *field, reached);
  return {};
}

}  // namespace

void add_bake(CLI::App& app, Run& run) {
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("bake", "Compute a scene's field, and write it to a file");
  command->group(kFieldGroup);
  command->option_defaults()->group(kMainGroup);
  command->add_option("-o,--output", o->output, "The field file to write, such as a.field")
      ->required()
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
      ->type_name("FILE");
  add_scene_options(*command, o->stage);
  add_field_options(*command, o->field);
  command->callback([o, &run] { run = [o] { return bake(*o); }; });
}

}  // namespace lambent::cli
