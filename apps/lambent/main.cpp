// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "lambent/command_line.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/help.h"
#include "lambent/interrupts.h"
#include "lambent/parse_errors.h"
#include "lambent/step.h"

namespace lambent::cli {
namespace {

// Exit statuses of the command line (docs/cli.md).
constexpr int kFailed = 1;
constexpr int kBadUsageOrInput = 2;

constexpr const char* kProgramExamples =
    "  lambent scene.glb                      render scene.png, with everything chosen\n"
    "  lambent render scene.glb -o a.exr --layers --size 1080p\n"
    "  lambent compare a.exr b.exr            measure how two pictures differ\n";

int report(const Error& error) {
  tell_error(error.message());
  return error.kind == Error::Kind::bad_input ? kBadUsageOrInput : kFailed;
}

/// Adds the options --help and --quiet that every subcommand has.
void add_common_options(CLI::App& command, bool& quiet) {
  command.get_help_ptr()->description("Print this, and exit")->group(kProgramGroup);
  command.add_flag("--quiet", quiet, "Say nothing of success, warnings and progress; errors stay")
      ->group(kProgramGroup);
  for (CLI::App* inner : command.get_subcommands({})) add_common_options(*inner, quiet);
}

void add_subcommands(CLI::App& app, Run& run) {
  add_render(app, run);
  add_picture(app, run);
  add_compare(app, run);
  add_info(app, run);
  add_scenes(app, run);
  add_make_scene(app, run);
  add_prepare(app, run);
  add_bake(app, run);
  add_field(app, run);
#if LAMBENT_STREAM
  add_serve(app, run);
  add_connect(app, run);
#endif
  add_devices(app, run);
}

/// Parses the arguments into `run`, which remains empty if only help was printed. Returns an exit
/// status, 0 if there was no error.
int parse(CLI::App& app, std::vector<std::string> typed, Run& run) {
  auto arguments = complete_arguments(app, std::move(typed));
  if (!arguments) return report(arguments.error());
  std::reverse(arguments->begin(), arguments->end());  // the order that CLI11 expects
  try {
    app.parse(std::move(*arguments));
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    run = {};
  } catch (const CLI::CallForVersion& version) {
    std::printf("%s\n", version.what());
    run = {};
  } catch (const CLI::ParseError& error) {
    tell_error(explain(app, error));
    return kBadUsageOrInput;
  }
  return 0;
}

int run_program(int argc, char** argv) {
  if (argc < 2) {
    std::fputs(short_help().c_str(), stderr);
    return kBadUsageOrInput;
  }
  CLI::App app("Lambent renders 3D scenes with light that bounces, and measures how right it is.",
               "lambent");
  app.set_version_flag("--version", "lambent " LAMBENT_VERSION, "Print the version, and exit")
      ->group(kProgramGroup);
  app.require_subcommand(1);
  Run run;
  bool quiet = false;
  add_subcommands(app, run);
  add_common_options(app, quiet);
  set_help_style(app);
  set_examples(app, kProgramExamples);

  if (const int status = parse(app, {argv + 1, argv + argc}, run); status != 0) return status;
  set_quiet(quiet);
  if (!run) return 0;
  const Expected<void> done = run();
  return done ? 0 : report(done.error());
}

}  // namespace
}  // namespace lambent::cli

int main(int argc, char** argv) {
  lambent::cli::clean_up_on_signals();
  int status = lambent::cli::kFailed;
  try {
    status = lambent::cli::run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    lambent::cli::tell_error(std::string("memory ran out while ") + lambent::cli::current_step());
  } catch (const std::exception& error) {
    lambent::cli::tell_error(error.what());
  }
  // Flush stdout: a full disk may be detected only now
  const auto printed = lambent::cli::finish_stdout();
  if (status == 0 && !printed) return lambent::cli::report(printed.error());
  return status;
}
