// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace lambent::cli {

/// An error message for a command line that `app` could not parse. It names the argument, suggests
/// the nearest known word for an unknown one, and refers to the help.
std::string explain(const CLI::App& app, const CLI::ParseError& error);

}  // namespace lambent::cli
