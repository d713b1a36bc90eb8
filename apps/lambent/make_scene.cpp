// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/help.h"
#include "lambent/output.h"
#include "lambent/validators.h"
#include "lambent/words.h"
#include "scenes/builtin.h"
#include "scenes/glb_writer.h"

namespace lambent::cli {
namespace {

struct MakeSceneOptions {
  std::string name;
  std::string output;
  bool sealed = false;
};

Expected<void> make_scene(const MakeSceneOptions& options) {
  const std::string name = options.name + (options.sealed ? "-sealed" : "");
  if (options.sealed && !scenes::is_name(name)) {
    return fail("--sealed", "", "goes with two-rooms alone");
  }
  if (const Expected<void> fine = check_output(options.output, {".glb"}); !fine) return fine;
  const Expected<scenes::AnimatedScene> made = scenes::make_animated(name);
  if (!made) return tl::unexpected(made.error());
  if (const auto fine = make_folders(options.output); !fine) return fine;
  const auto bytes = scenes::write_glb(made->scene, options.output, made->animations);
  if (!bytes) return tl::unexpected(bytes.error());
  tell_written(options.output, list_text({count_text(triangle_count(made->scene), "triangle"),
                                          count_text(made->scene.textures.size(), "texture"),
                                          count_text(made->scene.cameras.size(), "camera")},
                                         "and"));
  return {};
}

}  // namespace

void add_make_scene(CLI::App& app, Run& run) {
  auto options = std::make_shared<MakeSceneOptions>();
  CLI::App* command = app.add_subcommand("make-scene", "Write a built-in scene as a .glb file");
  command->group(kSceneGroup);
  command->add_option("NAME", options->name, "One of: " + list_text(scenes::names()))->required();
  command->add_option("-o,--output", options->output, "The .glb file to write")
      ->required()
      ->check(file_name())
      ->type_name("FILE");
  command->add_flag("--sealed", options->sealed, "two-rooms: close the gap in the wall");
  command->callback([options, &run] { run = [options] { return make_scene(*options); }; });
}

}  // namespace lambent::cli
