// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace lambent::cli {

/// What is wrong with a command line that `app` could not parse, in words that name what was typed,
/// with the nearest known word in place of one that is unknown, and where to read more.
std::string explain(const CLI::App& app, const CLI::ParseError& error);

}  // namespace lambent::cli
