// SPDX-License-Identifier: Apache-2.0
// What was typed, before it is parsed.
#pragma once

#include <string>
#include <vector>

#include "lambent/error.h"

namespace CLI {
class App;
}

namespace lambent::cli {

/// The arguments of a subcommand that were meant. What begins with a scene, or with an option of a
/// picture, is `render`; `help` and `help render` are --help. Fails on a first word that is neither
/// a subcommand nor a scene, with the nearest one.
Expected<std::vector<std::string>> complete_arguments(const CLI::App& app,
                                                      std::vector<std::string> arguments);

}  // namespace lambent::cli
