// SPDX-License-Identifier: Apache-2.0
#include "lambent/parse.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/nearest_word.h"
#include "lambent/validators.h"
#include "scene/limits.h"

namespace lambent::cli {
namespace {

constexpr int kMaxImageSide = 16384;
constexpr int kMinProbes = 2;
constexpr int kMaxProbes = 4096;

/// A common name for a size of pictures [pixels].
struct NamedSize {
  const char* name;
  int width, height;
};
constexpr NamedSize kSizes[] = {{"480p", 854, 480},    {"720p", 1280, 720},   {"1080p", 1920, 1080},
                                {"1440p", 2560, 1440}, {"2160p", 3840, 2160}, {"4k", 3840, 2160},
                                {"4320p", 7680, 4320}, {"8k", 7680, 4320}};

// With a larger exposure [stops], any picture is white or black.
constexpr double kMaxStops = 64.0;

/// The numbers between separators, or nothing if any part is not a number.
template <class T>
std::vector<T> split_numbers(std::string_view text, char separator) {
  std::vector<T> numbers;
  while (true) {
    const std::size_t end = std::min(text.find(separator), text.size());
    T number{};
    const char* last = text.data() + end;
    const auto [stop, error] = std::from_chars(text.data(), last, number);
    if (error != std::errc() || stop != last) return {};
    numbers.push_back(number);
    if (end == text.size()) return numbers;
    text.remove_prefix(end + 1);
  }
}

tl::unexpected<Error> malformed(const std::string& option, const std::string& text,
                                const char* wanted) {
  return fail(option, "", "'" + text + "' is not " + wanted);
}

Expected<std::vector<float>> parse_floats(const std::string& option, const std::string& text,
                                          std::size_t count, const char* wanted) {
  return parse_numbers(option, text, count, count, wanted);
}

Expected<std::vector<int>> parse_ints(const std::string& option, const std::string& text,
                                      std::size_t count, int low, int high, const char* wanted) {
  std::vector<int> numbers = split_numbers<int>(text, 'x');
  bool fine = numbers.size() == count;
  for (const int number : numbers) fine = fine && number >= low && number <= high;
  if (!fine) return malformed(option, text, wanted);
  return numbers;
}

/// Sets one "key=value" of a volume. Returns false for an unknown key or a bad value.
bool set_volume(const std::string& option, const std::string& key, const std::string& value,
                ProbeVolume& volume) {
  if (key == "probes") {
    const auto counts = parse_counts(option, value);
    if (counts) volume.probe_count = *counts;
    return counts.has_value();
  }
  if (key == "priority") {
    const std::vector<int> priority = split_numbers<int>(value, ',');
    if (priority.size() == 1) volume.priority = priority[0];
    return priority.size() == 1;
  }
  const std::vector<float> number = split_numbers<float>(value, ',');
  if (number.size() != 1 || !std::isfinite(number[0])) return false;
  if (key == "spacing" && number[0] > 0.0f) {
    volume.probe_spacing = number[0];
    return true;
  }
  if (key == "turn") {
    const float angle = glm::radians(number[0]);
    volume.axes = {{std::cos(angle), 0.0f, -std::sin(angle)},
                   {0.0f, 1.0f, 0.0f},
                   {std::sin(angle), 0.0f, std::cos(angle)}};
    return true;
  }
  return false;
}

}  // namespace

bool has_ending(const std::string& path, const char* ending) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ending;
}

Expected<std::vector<float>> parse_numbers(const std::string& option, const std::string& text,
                                           std::size_t least, std::size_t most,
                                           const char* wanted) {
  std::vector<float> numbers = split_numbers<float>(text, ',');
  bool fine = numbers.size() >= least && numbers.size() <= most;
  for (const float number : numbers) fine = fine && std::isfinite(number);
  if (!fine) return malformed(option, text, wanted);
  return numbers;
}

Expected<glm::vec3> parse_vec3(const std::string& option, const std::string& text) {
  const auto n = parse_floats(option, text, 3, "three numbers x,y,z");
  if (!n) return tl::unexpected(n.error());
  return glm::vec3((*n)[0], (*n)[1], (*n)[2]);
}

Expected<glm::vec3> parse_place(const std::string& option, const std::string& text) {
  const auto place = parse_vec3(option, text);
  if (place && !is_in_reach(*place)) {
    return malformed(option, text, "a place within 1e9 m of the origin");
  }
  return place;
}

Expected<Bounds> parse_box(const std::string& option, const std::string& text) {
  constexpr const char* kWanted = "a box x0,y0,z0,x1,y1,z1 whose second corner is greater";
  const auto n = parse_floats(option, text, 6, kWanted);
  if (!n) return tl::unexpected(n.error());
  const Bounds box{{(*n)[0], (*n)[1], (*n)[2]}, {(*n)[3], (*n)[4], (*n)[5]}};
  if (!glm::all(glm::lessThan(box.min, box.max))) return malformed(option, text, kWanted);
  if (!is_in_reach(box.min) || !is_in_reach(box.max)) {
    return malformed(option, text, "a box within 1e9 m of the origin");
  }
  return box;
}

Expected<glm::ivec2> parse_size(const std::string& option, const std::string& text) {
  std::vector<std::string> names;
  for (const NamedSize& size : kSizes) {
    if (text == size.name) return glm::ivec2(size.width, size.height);
    names.emplace_back(size.name);
  }
  const auto n = parse_ints(option, text, 2, 1, kMaxImageSide,
                            "a size: WxH, each 1 to 16384, or a name such as 720p, 1080p or 4k");
  if (n) return glm::ivec2((*n)[0], (*n)[1]);
  Error error = n.error();
  error.cause += did_you_mean(text, names);
  return tl::unexpected(error);
}

Expected<glm::ivec3> parse_counts(const std::string& option, const std::string& text) {
  const auto n =
      parse_ints(option, text, 3, kMinProbes, kMaxProbes, "counts XxYxZ, each 2 to 4096");
  if (!n) return tl::unexpected(n.error());
  return glm::ivec3((*n)[0], (*n)[1], (*n)[2]);
}

Expected<ProbeVolume> parse_volume(const std::string& option, const std::string& text) {
  std::size_t end = std::min(text.find(':'), text.size());
  const auto box = parse_box(option, text.substr(0, end));
  if (!box) return tl::unexpected(box.error());
  ProbeVolume volume;
  volume.name = text;
  volume.centre = 0.5f * (box->min + box->max);
  volume.size = box->max - box->min;
  while (end < text.size()) {
    const std::size_t begin = end + 1;
    end = std::min(text.find(':', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string value = equals < part.size() ? part.substr(equals + 1) : "";
    if (!set_volume(option, part.substr(0, equals), value, volume)) {
      return malformed(option, part,
                       "one of spacing=METRES, probes=XxYxZ, turn=DEGREES and priority=NUMBER");
    }
  }
  if (volume.probe_count != glm::ivec3(0) && volume.probe_spacing > 0.0f) {
    return fail(option, "", "give either probes or spacing");
  }
  return volume;
}

Expected<std::optional<float>> parse_exposure(const std::string& text) {
  if (text == "auto") return std::optional<float>();
  const std::optional<double> stops = finite_number(text);
  if (!stops || std::abs(*stops) > kMaxStops) {
    return fail("--exposure", "",
                "'" + text + "' is neither auto nor a number of stops, -64 to 64");
  }
  return std::optional<float>(static_cast<float>(*stops));
}

}  // namespace lambent::cli
