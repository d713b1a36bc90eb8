// SPDX-License-Identifier: Apache-2.0
#include "lambent/validators.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/nearest_word.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

/// The value of a whole text, or nothing. It may begin with a plus sign.
template <class T>
std::optional<T> value_of(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  const char* const last = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || stop != last) return std::nullopt;
  return value;
}

std::string text_of(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

std::string refusal(const std::string& text, const std::string& wanted) {
  return "'" + text + "' is not " + wanted;
}

/// `fits` tests finite numbers; `wanted` describes the valid ones.
template <class Fits>
CLI::Validator finite(std::string wanted, Fits fits) {
  const auto check = [wanted = std::move(wanted), fits](std::string& text) -> std::string {
    const std::optional<double> value = finite_number(text);
    return value && fits(*value) ? "" : refusal(text, wanted);
  };
  return CLI::Validator(check, "");
}

}  // namespace

std::optional<double> finite_number(std::string_view text) {
  const std::optional<double> value = value_of<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

CLI::Validator whole_number(std::int64_t low, std::int64_t high) {
  const auto check = [low, high](std::string& text) -> std::string {
    const std::optional<std::int64_t> value = value_of<std::int64_t>(text);
    if (!value || *value < low || *value > high) {
      const std::string range = std::to_string(low) + " to " + std::to_string(high);
      return refusal(text, "a whole number from " + range);
    }
    text = std::to_string(*value);  // CLI11 would read leading zeros as octal
    return "";
  };
  return CLI::Validator(check, "");
}

CLI::Validator number(double low, double high) {
  return finite("a number from " + text_of(low) + " to " + text_of(high),
                [low, high](double value) { return value >= low && value <= high; });
}

CLI::Validator number_above_zero(double high) {
  // Test as a float, since numbers below the smallest float become 0
  return finite("a number above 0, up to " + text_of(high),
                [high](double value) { return static_cast<float>(value) > 0.0f && value <= high; });
}

CLI::Validator file_name() {
  return CLI::Validator(
      [](std::string& text) { return text.empty() ? refusal(text, "the name of a file") : ""; },
      "");
}

std::string unlike_any_of(const std::string& word, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return "";
  return refusal(word, "one of " + list_text(known, "and")) + did_you_mean(word, known);
}

CLI::Validator one_of(std::vector<std::string> known) {
  const auto check = [known = std::move(known)](std::string& text) {
    return unlike_any_of(text, known);
  };
  return CLI::Validator(check, "");
}

}  // namespace lambent::cli
