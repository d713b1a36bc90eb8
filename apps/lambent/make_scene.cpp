// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "lambent/commands.h"
#include "lambent/parse.h"
#include "scenes/builtin.h"
#include "scenes/glb_writer.h"

namespace lambent::cli {
namespace {

struct Options {
  std::string name;
  std::string output;
  bool sealed = false;
};

Expected<void> make_scene(const Options& options) {
  const std::string name = options.name + (options.sealed ? "-sealed" : "");
  if (options.sealed && !scenes::is_name(name)) {
    return fail("--sealed", "", "goes with two-rooms alone");
  }
  if (const Expected<void> fine = check_output(options.output, ".glb"); !fine) return fine;
  const Expected<scenes::AnimatedScene> made = scenes::make_animated(name);
  if (!made) return tl::unexpected(made.error());
  const Expected<std::size_t> bytes =
      scenes::write_glb(made->scene, options.output, made->animations);
  if (!bytes) return tl::unexpected(bytes.error());
  std::printf("%s: %zu triangles, %zu textures, %zu cameras, %zu bytes\n", options.output.c_str(),
              triangle_count(made->scene), made->scene.textures.size(), made->scene.cameras.size(),
              *bytes);
  return {};
}

}  // namespace

void add_make_scene(CLI::App& app, Run& run) {
  auto options = std::make_shared<Options>();
  std::string known;
  for (const std::string& name : scenes::names()) known += (known.empty() ? "" : ", ") + name;
  CLI::App* command = app.add_subcommand("make-scene", "Write a built-in scene as a .glb file");
  command->add_option("name", options->name, "One of: " + known)->required();
  command->add_option("-o,--output", options->output, "The .glb file to write")->required();
  command->add_flag("--sealed", options->sealed, "two-rooms: close the gap in the wall");
  command->callback([options, &run] { run = [options] { return make_scene(*options); }; });
}

}  // namespace lambent::cli
