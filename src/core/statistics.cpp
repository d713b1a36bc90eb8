// SPDX-License-Identifier: Apache-2.0
#include "core/statistics.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"

namespace lambent {
namespace {

/// Above this not every whole number is a double.
constexpr double kLargestExactInteger = 9007199254740992.0;

nlohmann::ordered_json json_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  const bool whole = value == std::floor(value) && std::abs(value) < kLargestExactInteger;
  if (whole) return static_cast<std::int64_t>(value);
  return value;
}

}  // namespace

void Statistics::set(const std::string& key, double value) {
  for (auto& [name, number] : entries_) {
    if (name != key) continue;
    number = value;
    return;
  }
  entries_.emplace_back(key, value);
}

void Statistics::add(const std::string& key, double value) {
  const double* old = find(key);
  set(key, (old != nullptr ? *old : 0.0) + value);
}

const double* Statistics::find(const std::string& key) const {
  for (const auto& [name, number] : entries_) {
    if (name == key) return &number;
  }
  return nullptr;
}

std::string Statistics::json() const {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [name, number] : entries_) object[name] = json_number(number);
  constexpr int kIndent = 2;
  return object.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Expected<void> Statistics::write(const std::string& path) const {
  return write_file_atomically(path, json());
}

}  // namespace lambent
