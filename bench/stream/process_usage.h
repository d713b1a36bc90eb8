// SPDX-License-Identifier: Apache-2.0
// Resources that a process has used so far, with all of its threads.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace lambent::stream_load {

struct ProcessUsage {
  double cpu_s = 0.0, rss_mb = 0.0;
};

/// Zeros where there is no such process.
inline ProcessUsage usage_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text(std::istreambuf_iterator<char>(file), {});
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  // Skip the name in parentheses, which may contain anything
  std::istringstream fields(text.substr(name_end + 2));
  constexpr int kUserTime = 11, kResident = 21;  // counted from the state on
  std::vector<double> numbers;
  std::string field;
  for (int i = 0; i <= kResident && fields >> field; ++i) {
    numbers.push_back(std::atof(field.c_str()));
  }
  if (numbers.size() <= kResident) return {};
  constexpr double kBytesOfMb = 1e6;
  return {(numbers[kUserTime] + numbers[kUserTime + 1]) / static_cast<double>(sysconf(_SC_CLK_TCK)),
          numbers[kResident] * static_cast<double>(sysconf(_SC_PAGESIZE)) / kBytesOfMb};
}

/// Number of its open files and sockets.
inline int descriptors_of(pid_t process) {
  std::error_code ignored;
  const std::filesystem::directory_iterator files("/proc/" + std::to_string(process) + "/fd",
                                                  ignored);
  return static_cast<int>(std::distance(begin(files), end(files)));
}

}  // namespace lambent::stream_load
