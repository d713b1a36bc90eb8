// SPDX-License-Identifier: Apache-2.0
// Completion of command lines, before they are parsed.
#pragma once

#include <string>
#include <vector>

#include "lambent/error.h"

namespace CLI {
class App;
}

namespace lambent::cli {

/// The arguments with the implied subcommand. Arguments that begin with a scene, or with an option
/// of a picture, get `render`; `help` and `help render` become --help. Fails on a first word that
/// is neither a subcommand nor a scene, with the nearest one.
Expected<std::vector<std::string>> complete_arguments(const CLI::App& app,
                                                      std::vector<std::string> arguments);

}  // namespace lambent::cli
