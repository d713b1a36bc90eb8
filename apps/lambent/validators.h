// SPDX-License-Identifier: Apache-2.0
// Validators of option values. Each option with a number or a choice has one of these, so that all
// invalid values are refused with the same message: the option's name, and the valid values.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambent::cli {

/// The number that a whole text represents, in decimal, or nothing; "nan" and "inf" are not
/// numbers.
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

/// Accepts text that is not empty. Shells pass an empty text for a variable that is not set.
CLI::Validator file_name();

/// One of some words; for others, the error suggests the nearest.
CLI::Validator one_of(std::vector<std::string> known);

/// The message of one_of for an unknown word; empty for a known one.
std::string unlike_any_of(const std::string& word, const std::vector<std::string>& known);

}  // namespace lambent::cli
