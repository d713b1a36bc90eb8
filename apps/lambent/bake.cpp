// SPDX-License-Identifier: Apache-2.0
// lambent bake: a field that has settled, in a file.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/atomic_file.h"
#include "lambent/commands.h"
#include "lambent/field_options.h"
#include "lambent/progress_bar.h"
#include "lambent/stage.h"
#include "lambent/threads.h"
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
  for (const std::string& path : {options.output, options.stats}) {
    if (path.empty()) continue;
    if (const Expected<void> fine = check_writable(path); !fine) return fine;
  }
  if (options.time_s && !std::isfinite(*options.time_s)) {
    return fail("--time", "", "is not a finite number of seconds");
  }
  return {};
}

void tell(const Options& options, const IrradianceField& field, const FieldProgress& reached) {
  const double percent = 100.0 * reached.change;
  const char* how = options.updates > 0 ? "made" : reached.settled ? "settled" : "not settled";
  std::printf("%s after %d updates: the last changed the light by %.3g %%\n", how, reached.updates,
              percent);
  std::printf("%d probes, %zu bytes each: %s\n", field.probes(),
              field.store_bytes() / static_cast<std::size_t>(field.probes()),
              options.output.c_str());
}

Expected<void> bake(const Options& options) {
  if (const auto fine = check(options); !fine) return fine;
  // What is wrong with the options is told before the scene is read
  if (const auto fine = field_settings(options.field, {}, options.seed, options.bounces); !fine) {
    return tl::unexpected(fine.error());
  }
  const ThreadLimit limit(options.threads);

  Expected<Scene> scene = open_stage(options.stage);
  if (!scene) return tl::unexpected(scene.error());
  if (options.time_s) {
    if (scene->animations.empty()) {
      return fail("--time", "", "the scene has no animation that can be played");
    }
    animate(*scene, -1, *options.time_s);
  }
  World world(*scene);
  const Expected<View> view = choose_view(options.stage, world, FirstViewSettings().aspect);
  if (!view) return tl::unexpected(view.error());
  const auto light = add_first_light(options.stage.light, view->camera, *scene, world);
  if (!light) return tl::unexpected(light.error());
  std::fprintf(stderr, "lambent: light: %s\n", light->c_str());
  const auto settings = field_settings(options.field, *scene, options.seed, options.bounces);
  if (!settings) return tl::unexpected(settings.error());
  Expected<IrradianceField> field = IrradianceField::make(*settings, open_bounds(world));
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
  if (const auto saved = save_field(options.output, *field, world); !saved) return saved;
  tell(options, *field, reached);
  if (options.stats.empty()) return {};
  return write_file_atomically(options.stats, stats.dump(2) + "\n");
}

}  // namespace

void add_bake(CLI::App& app, Run& run) {
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("bake", "Compute a scene's field, and write it to a file");
  add_scene_options(*command, o->stage);
  command->add_option("-o,--output", o->output, "The field file to write")->required();
  command->add_option("--time", o->time_s, "Time of the scene's animation [s]");
  command->add_option("--updates", o->updates, "Update so often (until the light has settled)")
      ->check(CLI::Range(1, kMaxUpdates));
  command->add_option("--bounces", o->bounces, "Bounces of indirect light (all of them)")
      ->check(CLI::Range(0, kMaxBounces));
  command->add_option("--seed", o->seed, "Of all random numbers")->capture_default_str();
  command->add_option("--threads", o->threads, "Threads to use (all)")
      ->check(CLI::Range(1, kMaxThreads));
  command->add_option("--stats", o->stats, "Write times and counts to this .json file");
  add_field_options(*command, o->field);
  command->callback([o, &run] { run = [o] { return bake(*o); }; });
}

}  // namespace lambent::cli
