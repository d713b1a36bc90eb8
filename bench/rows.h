// SPDX-License-Identifier: Apache-2.0
// A program that measures the rows of a table which it is asked for.
#pragma once

#include <functional>
#include <map>
#include <string>

namespace lambent::bench {

/// Rows by the names that the command line has for them; each prints a Markdown table.
using Rows = std::map<std::string, std::function<void()>>;

/// Measures the rows that the arguments name, in their order. Returns the program's exit status: 2
/// where there is no such row, 1 where one threw.
int run_rows(const char* program, const Rows& rows, int argc, char** argv);

}  // namespace lambent::bench
