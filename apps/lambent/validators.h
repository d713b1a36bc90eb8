// SPDX-License-Identifier: Apache-2.0
// What values of options may be. Each option with a number or a choice has one of these, so that a
// value that will not do is refused in one way: by the option's name, with what would do.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambent::cli {

/// The number that all of a text is, in decimal, or nothing; "nan" and "inf" are no numbers.
std::optional<double> finite_number(std::string_view text);

/// Whole numbers from `low` to `high`.
CLI::Validator whole_number(std::int64_t low = std::numeric_limits<int>::min(),
                            std::int64_t high = std::numeric_limits<int>::max());

/// Times beyond this are typing errors: 30 years [s].
inline constexpr double kMaxTime = 1e9;

/// Finite numbers from `low` to `high`.
CLI::Validator number(double low, double high);

/// Finite numbers above 0, up to `high`.
CLI::Validator number_above_zero(double high);

/// One of some words; the nearest of them is offered in place of another.
CLI::Validator one_of(std::vector<std::string> known);

/// What one_of says of a word that it does not know; empty where it knows the word.
std::string unlike_any_of(const std::string& word, const std::vector<std::string>& known);

}  // namespace lambent::cli
