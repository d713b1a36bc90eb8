// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/document/schema.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/gltf/document/schema_rules.h"

namespace lambent::gltf {
namespace {

using nlohmann::json;

// A bound for display: whole numbers without an exponent.
std::string text_of(double bound) {
  char text[32];
  const bool whole = bound == std::floor(bound) && std::abs(bound) <= kAnySize;
  std::snprintf(text, sizeof text, whole ? "%.0f" : "%.6g", bound);
  return text;
}

class Checker {
 public:
  Checker(json& root, const std::string& file) : root_(root), file_(file) {}

  /// Places of the numbers that were brought into their range.
  std::vector<std::string> repaired;

  Expected<void> check_object(json& value, const char* shape, const std::string& place) {
    if (!value.is_object()) return wrong(place.empty() ? "JSON" : place, "must be an object");
    for (const Rule& rule : kRules) {
      if (std::strcmp(rule.shape, shape) != 0) continue;
      const auto member = value.find(rule.key);
      const std::string member_place = place.empty() ? rule.key : place + "." + rule.key;
      if (member == value.end()) {
        if (rule.required) return wrong(member_place, "is required but missing");
        continue;
      }
      if (rule.kind == Kind::reach) {
        if (!member->is_number()) return wrong(member_place, "must be a number");
        if (member->get<double>() >= kTiny && member->get<double>() <= kAnyFloat) continue;
        repaired.push_back(member_place);
        value.erase(member);
        continue;
      }
      if (Expected<void> fine = check_value(*member, rule, member_place); !fine) return fine;
    }
    return {};
  }

 private:
  tl::unexpected<Error> wrong(const std::string& place, const std::string& cause) const {
    return fail(file_, place, cause);
  }

  // Applies `check(entry, place)` to each entry of a list.
  template <class Check>
  Expected<void> each(json& value, const std::string& place, Check check) const {
    if (!value.is_array()) return wrong(place, "must be a list");
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string entry_place = place + "[" + std::to_string(i) + "]";
      if (Expected<void> fine = check(value[i], entry_place); !fine) return fine;
    }
    return {};
  }

  template <class Check>
  Expected<void> each_member(json& value, const std::string& place, Check check) const {
    if (!value.is_object()) return wrong(place, "must be an object");
    for (auto& [key, member] : value.items()) {
      if (Expected<void> fine = check(member, place + "." + key); !fine) return fine;
    }
    return {};
  }

  Expected<void> check_index(const json& value, const char* target,
                             const std::string& place) const {
    const json::json_pointer pointer(target);
    const std::size_t size = root_.contains(pointer) ? root_[pointer].size() : 0;
    if (!value.is_number_unsigned()) return wrong(place, "must be a whole number of 0 or more");
    const auto index = value.get<std::uint64_t>();
    if (index < size) return {};
    return wrong(place, "is " + std::to_string(index) + ", but there are only " +
                            std::to_string(size) + " " + (std::strrchr(target, '/') + 1));
  }

  Expected<void> check_number(const json& value, const Rule& rule, const std::string& place) const {
    if (!value.is_number()) return wrong(place, "must be a number");
    const double number = value.get<double>();
    if (number >= rule.low && number <= rule.high) return {};
    return wrong(place, "is " + value.dump() + ", which is not within " + text_of(rule.low) +
                            " to " + text_of(rule.high));
  }

  /// Brings a number into its range.
  Expected<void> check_factor(json& value, const Rule& rule, const std::string& place) {
    if (!value.is_number()) return wrong(place, "must be a number");
    const double number = value.get<double>();
    const double within = std::clamp(number, rule.low, rule.high);
    if (within == number) return {};
    repaired.push_back(place);
    value = within;
    return {};
  }

  Expected<void> check_numbers(json& value, const Rule& rule, const std::string& place) const {
    const double largest = rule.low != 0.0 ? rule.low : kAnyFloat;
    const Rule any = {"", "", Kind::number, "", -largest, largest, false};
    const auto length = static_cast<std::size_t>(rule.high);
    if (length != 0 && value.is_array() && value.size() != length) {
      return wrong(place, "must be a list of " + std::to_string(length) + " numbers");
    }
    return each(value, place,
                [&](const json& v, const std::string& p) { return check_number(v, any, p); });
  }

  Expected<void> check_value(json& value, const Rule& rule, const std::string& place) {
    const auto as_index = [&](const json& v, const std::string& p) {
      return check_index(v, rule.of, p);
    };
    const auto as_string = [&](const json& v, const std::string& p) -> Expected<void> {
      if (!v.is_string()) return wrong(p, "must be a string");
      return {};
    };
    const auto as_whole = [&](const json& v, const std::string& p) -> Expected<void> {
      if (!v.is_number_integer()) return wrong(p, "must be a whole number");
      return check_number(v, rule, p);
    };
    switch (rule.kind) {
      case Kind::object:
        return check_object(value, rule.of, place);
      case Kind::list:
        return each(value, place,
                    [&](json& v, const std::string& p) { return check_object(v, rule.of, p); });
      case Kind::index:
        return as_index(value, place);
      case Kind::indices:
        return each(value, place, as_index);
      case Kind::attributes:
        return each_member(value, place, as_index);
      case Kind::attribute_sets:
        return each(value, place,
                    [&](json& v, const std::string& p) { return each_member(v, p, as_index); });
      case Kind::ids:
        return each_member(value, place, as_whole);
      case Kind::whole:
        return as_whole(value, place);
      case Kind::number:
        return check_number(value, rule, place);
      case Kind::factor:
        return check_factor(value, rule, place);
      case Kind::reach:
        break;  // check_object() removes members
      case Kind::numbers:
        return check_numbers(value, rule, place);
      case Kind::string:
        return as_string(value, place);
      case Kind::strings:
        return each(value, place, as_string);
      case Kind::boolean:
        if (!value.is_boolean()) return wrong(place, "must be true or false");
        return {};
    }
    return {};
  }

  const json& root_;
  const std::string& file_;
};

}  // namespace

Expected<std::vector<std::string>> check_schema(json& root, const std::string& file) {
  Checker checker(root, file);
  const Expected<void> fine = checker.check_object(root, "root", "");
  if (!fine) return tl::unexpected(fine.error());
  return std::move(checker.repaired);
}

}  // namespace lambent::gltf
