// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "lambent/commands.h"
#include "lambent/interrupts.h"
#include "lambent/step.h"

namespace {

// Exit statuses of the command line (docs/cli.md).
constexpr int kFailed = 1;
constexpr int kBadUsageOrInput = 2;

int report(const lambent::Error& error) {
  std::fprintf(stderr, "lambent: %s\n", error.message().c_str());
  return error.kind == lambent::Error::Kind::bad_input ? kBadUsageOrInput : kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  lambent::cli::clean_up_on_signals();
  CLI::App app("Dynamic global illumination, measured against a reference.", "lambent");
  app.set_version_flag("--version", "lambent " LAMBENT_VERSION);
  app.require_subcommand(1);

  lambent::cli::Run run;
  lambent::cli::add_bake(app, run);
  lambent::cli::add_compare(app, run);
  lambent::cli::add_devices(app, run);
  lambent::cli::add_field(app, run);
  lambent::cli::add_info(app, run);
  lambent::cli::add_make_scene(app, run);
  lambent::cli::add_picture(app, run);
  lambent::cli::add_prepare(app, run);
  lambent::cli::add_render(app, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& version) {
    return app.exit(version);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "lambent: %s (see lambent --help)\n", error.what());
    return kBadUsageOrInput;
  }

  try {
    if (const lambent::Expected<void> done = run(); !done) return report(done.error());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "lambent: memory ran out while %s\n", lambent::cli::current_step());
    return kFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lambent: %s\n", error.what());
    return kFailed;
  }
  return 0;
}
