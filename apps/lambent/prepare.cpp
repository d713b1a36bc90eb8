// SPDX-License-Identifier: Apache-2.0
// lambent prepare: writes a scene to a file for machines that cannot read other formats.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/help.h"
#include "lambent/output.h"
#include "lambent/scene_options.h"
#include "lambent/step.h"
#include "lambent/validators.h"
#include "lambent/words.h"
#include "lambent/world.h"
#include "scene/prepared.h"

namespace lambent::cli {
namespace {

// Default limit of textures' sizes [texels], which includes all textures.
constexpr int kAnyTextureSize = 16384;

struct PrepareOptions {
  SceneOptions scene;
  std::string output;
  int texture_size = kAnyTextureSize;
};

Expected<void> prepare(const PrepareOptions& options) {
  if (const Expected<void> fine = check_own_output(options.output, "a prepared scene"); !fine)
    return fine;
  CommandFiles files;
  files.reads_scene(options.scene.file);
  files.reads(options.scene.light.environment, "--environment");
  files.writes(options.output, "-o");
  if (const auto distinct = files.check(); !distinct) return distinct;
  begin_step("reading the scene");
  Expected<OpenedScene> opened = open_lit_scene(options.scene);
  if (!opened) return tl::unexpected(opened.error());
  Scene& scene = opened->scene;
  World world(scene);
  const Expected<View> view = choose_view(options.scene, world, FirstViewSettings().aspect);
  if (!view) return tl::unexpected(view.error());
  const auto light =
      add_first_light(options.scene.light, view->camera, opened->sky_dome, scene, world);
  if (!light) return tl::unexpected(light.error());
  scene.cameras.insert(scene.cameras.begin(), view->camera);
  limit_textures(scene, options.texture_size);
  if (const auto fine = make_folders(options.output); !fine) return fine;
  if (const auto saved = save_prepared(scene, options.output); !saved) return saved;
  tell_written(options.output, count_text(triangle_count(scene), "triangle") + " and " +
                                   count_text(scene.textures.size(), "texture"));
  return {};
}

}  // namespace

void add_prepare(CLI::App& app, Run& run) {
  auto options = std::make_shared<PrepareOptions>();
  CLI::App* command =
      app.add_subcommand("prepare", "Write a scene as a file that lambent_gpu_bench reads");
  add_scene_and_view_options(*command, options->scene);
  command->group(kSceneGroup);
  command->option_defaults()->group("The file");
  command->add_option("-o,--output", options->output, "The file to write")
      ->required()
      ->check(file_name())
      ->type_name("FILE");
  command->add_option("--texture-size", options->texture_size, "Longest side of textures [texels]")
      ->check(whole_number(1, kAnyTextureSize))
      ->type_name("N");
  command->callback([options, &run] { run = [options] { return prepare(*options); }; });
}

}  // namespace lambent::cli
