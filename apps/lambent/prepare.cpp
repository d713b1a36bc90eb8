// SPDX-License-Identifier: Apache-2.0
// lambent prepare: a scene in a file for machines that cannot read any other.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "core/atomic_file.h"
#include "lambent/commands.h"
#include "lambent/stage.h"
#include "lambent/world.h"
#include "scene/prepared.h"

namespace lambent::cli {
namespace {

// Textures are at most this long where nothing else is asked for: all that there are.
constexpr int kAnyTextureSize = 16384;

struct Options {
  StageOptions stage;
  std::string output;
  int texture_size = kAnyTextureSize;
};

Expected<void> prepare(const Options& options) {
  if (const Expected<void> fine = check_writable(options.output); !fine) return fine;
  Expected<Scene> scene = open_stage(options.stage);
  if (!scene) return tl::unexpected(scene.error());
  World world(*scene);
  const Expected<View> view = choose_view(options.stage, world, FirstViewSettings().aspect);
  if (!view) return tl::unexpected(view.error());
  const auto light = add_first_light(options.stage.light, view->camera, *scene, world);
  if (!light) return tl::unexpected(light.error());
  scene->cameras.insert(scene->cameras.begin(), view->camera);
  limit_textures(*scene, options.texture_size);
  if (const auto saved = save_prepared(*scene, options.output); !saved) return saved;
  std::printf("%s: %zu triangles, %zu textures, %ju bytes\n", options.output.c_str(),
              triangle_count(*scene), scene->textures.size(),
              std::uintmax_t{std::filesystem::file_size(options.output)});
  return {};
}

}  // namespace

void add_prepare(CLI::App& app, Run& run) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("prepare", "Write a scene as a file that lambent_gpu_bench reads");
  add_stage_options(*command, options->stage);
  command->add_option("-o,--output", options->output, "The file to write")->required();
  command->add_option("--texture-size", options->texture_size, "Longest side of textures [texels]")
      ->check(CLI::Range(1, kAnyTextureSize));
  command->callback([options, &run] { run = [options] { return prepare(*options); }; });
}

}  // namespace lambent::cli
