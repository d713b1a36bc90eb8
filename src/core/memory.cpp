// SPDX-License-Identifier: Apache-2.0
#include "core/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace lambent {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t less(std::uint64_t from, std::uint64_t taken) {
  return from > taken ? from - taken : 0;
}

/// The number in a file that contains nothing else; none where it contains a word ("max") or does
/// not exist.
std::optional<std::uint64_t> number_in(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

/// The number after a key at the start of a line, such as "MemAvailable:".
std::optional<std::uint64_t> number_after(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    std::uint64_t number = 0;
    if (words >> word >> number && word == key) return number;
  }
  return std::nullopt;
}

/// Memory that the system can provide without swapping (proc(5), MemAvailable).
std::uint64_t left_by_system(const std::string& root) {
  constexpr std::uint64_t kKibibyte = 1024;
  const auto kibibytes = number_after(root + "/proc/meminfo", "MemAvailable:");
  return kibibytes ? *kibibytes * kKibibyte : kUnlimited;
}

/// Memory that one control group leaves; cached files count as free.
std::uint64_t left_by_group(const std::string& folder, const char* limit_name, const char* use_name,
                            const char* cache_key) {
  const auto limit = number_in(folder + limit_name), use = number_in(folder + use_name);
  if (!limit || !use) return kUnlimited;
  return less(*limit, less(*use, number_after(folder + "/memory.stat", cache_key).value_or(0)));
}

/// Memory that the process's control groups leave, each of which limits those below it
/// (cgroups(7)).
std::uint64_t left_by_groups(const std::string& root) {
  std::uint64_t left = kUnlimited;
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    // "0::/user.slice" of version 2, "9:memory:/docker/1234" of version 1
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool unified = controllers.empty();
    if (!unified && controllers.find("memory") == std::string::npos) continue;
    const std::string base = root + (unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory");
    std::string group = line.substr(second + 1);
    while (true) {
      const std::string folder = base + group;
      left = std::min(
          left, unified ? left_by_group(folder, "/memory.max", "/memory.current", "inactive_file")
                        : left_by_group(folder, "/memory.limit_in_bytes", "/memory.usage_in_bytes",
                                        "total_inactive_file"));
      const std::size_t slash = group.rfind('/');
      if (slash == std::string::npos || group == "/") break;
      group.resize(slash);
    }
  }
  return left;
}

/// Memory that the limit of address space leaves (getrlimit(2), RLIMIT_AS).
std::uint64_t left_by_limits(const std::string& root) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const std::uint64_t pages = number_in(root + "/proc/self/statm").value_or(0);
  return less(limit.rlim_cur, pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)));
}

}  // namespace

std::uint64_t available_memory(const std::string& root) {
  return std::min({left_by_system(root), left_by_groups(root), left_by_limits(root)});
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array kUnits = {"bytes", "kB", "MB", "GB", "TB", "PB", "EB"};
  constexpr double kStep = 1000.0;
  auto number = static_cast<double>(bytes);
  std::size_t unit = 0;
  // From 999.5 on, three digits would round to a thousand
  while (number >= kStep - 0.5 && unit + 1 < kUnits.size()) {
    number /= kStep;
    ++unit;
  }
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), number < 10.0 && unit > 0 ? "%.1f %s" : "%.0f %s", number,
                kUnits[unit]);
  return text.data();
}

}  // namespace lambent
