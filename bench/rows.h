// SPDX-License-Identifier: Apache-2.0
// The main function of programs that measure rows of a table.
#pragma once

#include <functional>
#include <map>
#include <string>

namespace lambent::bench {

/// Rows by their names on the command line; each prints a Markdown table.
using Rows = std::map<std::string, std::function<void()>>;

/// Measures the rows that the arguments name, in order. Returns the program's exit status: 2 if
/// there is no such row, 1 if one threw.
int run_rows(const char* program, const Rows& rows, int argc, char** argv);

}  // namespace lambent::bench
