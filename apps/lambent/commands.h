// SPDX-License-Identifier: Apache-2.0
// The subcommands. Each add_* declares its options on `app` and, when its subcommand is chosen,
// sets `run`.
#pragma once

#include <functional>

#include "lambent/error.h"

namespace CLI {
class App;
}

namespace lambent::cli {

/// Runs the chosen subcommand, after all arguments were found to be well formed.
using Run = std::function<Expected<void>()>;

void add_bake(CLI::App& app, Run& run);
void add_compare(CLI::App& app, Run& run);
void add_devices(CLI::App& app, Run& run);
void add_field(CLI::App& app, Run& run);
void add_info(CLI::App& app, Run& run);
void add_make_scene(CLI::App& app, Run& run);
void add_picture(CLI::App& app, Run& run);
void add_prepare(CLI::App& app, Run& run);
void add_render(CLI::App& app, Run& run);
void add_scenes(CLI::App& app, Run& run);

// In builds with LAMBENT_STREAM only.
void add_connect(CLI::App& app, Run& run);
void add_serve(CLI::App& app, Run& run);

}  // namespace lambent::cli
