// SPDX-License-Identifier: Apache-2.0
#include "lambent/words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/nearest_word.h"

namespace lambent::cli {
namespace {

constexpr long kSecondsPerMinute = 60, kMinutesPerHour = 60;

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace

std::string bytes_text(double bytes) {
  constexpr double kStep = 1000.0;
  // From here on "%.1f" would print 1000.0 of a unit
  constexpr double kRoundsToStep = 999.95;
  if (bytes < kStep) return formatted("%.0f bytes", bytes);
  const char* unit = "";
  for (const char* next : {"kB", "MB", "GB", "TB"}) {
    bytes /= kStep;
    unit = next;
    if (bytes < kRoundsToStep) break;
  }
  return formatted("%.1f %s", bytes, unit);
}

std::string whole_seconds_text(double seconds) {
  constexpr double kMostSeconds = 1e9;  // 30 years, which fits into any long
  const long whole = std::lround(std::clamp(seconds, 0.0, kMostSeconds));
  const long minutes = whole / kSecondsPerMinute, hours = minutes / kMinutesPerHour;
  if (minutes == 0) return formatted("%ld s", whole);
  if (hours == 0) return formatted("%ld min %02ld s", minutes, whole % kSecondsPerMinute);
  return formatted("%ld h %02ld min", hours, minutes % kMinutesPerHour);
}

std::string seconds_text(double seconds) {
  constexpr double kTwoDigits = 10.0;  // [s] below which hundredths are printed
  if (seconds < kTwoDigits) return formatted("%.2f s", seconds);
  // From here on "%.1f" would print 60.0
  constexpr double kRoundsToMinute = 59.95;
  return seconds < kRoundsToMinute ? formatted("%.1f s", seconds) : whole_seconds_text(seconds);
}

std::string count_text(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

std::string list_text(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " " + std::string(last) + " " : ", ";
    text += words[i];
  }
  return text;
}

std::string pixels_text(int width, int height) {
  return formatted("%dx%d pixels", width, height);
}

std::string exposure_text(float stops) {
  return formatted("exposure %+.2f stops", static_cast<double>(stops));
}

std::string printable(const std::string& text) {
  std::string clean;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    clean += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return clean;
}

bool same_but_for_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

std::optional<std::size_t> index_of(const std::string& wanted,
                                    const std::vector<std::string>& names) {
  const auto place = [&](auto found) { return static_cast<std::size_t>(found - names.begin()); };
  if (const auto found = std::ranges::find(names, wanted); found != names.end()) {
    return place(found);
  }
  std::size_t index = 0;
  const char* last = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(wanted.data(), last, index);
  if (error == std::errc() && stop == last && index < names.size()) return index;
  const auto same = [&](const std::string& name) { return same_but_for_case(name, wanted); };
  if (std::ranges::count_if(names, same) != 1) return std::nullopt;
  return place(std::ranges::find_if(names, same));
}

std::string no_such(const std::string& kind, const std::string& wanted,
                    const std::vector<std::string>& names) {
  constexpr std::size_t kMostListed = 16;
  std::string text = "no " + kind + " '" + wanted + "'; the scene has ";
  if (names.empty()) return text + "none";
  text += count_text(names.size(), kind) + ": ";
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(i) + " '" + printable(names[i]) + "'";
  }
  if (names.size() > kMostListed) text += ", ...";
  return text + printable(did_you_mean(wanted, names));
}

}  // namespace lambent::cli
