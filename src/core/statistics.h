// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "lambent/error.h"

namespace lambent {

/// How long a pass took. The name is the pass's everywhere: statistics, benches, debug labels.
struct PassTime {
  std::string name;
  double ms = 0.0;  ///< Wall clock.
};

/// Wall-clock time since it was made or last restarted.
class Stopwatch {
 public:
  void restart() { start_ = Clock::now(); }
  double ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Numbers under names with their unit ("trace_ms", "bytes_per_probe"), in the order in which they were first set.
class Statistics {
 public:
  void set(const std::string& key, double value);
  /// Adds to the number of that name; one that is missing counts as 0.
  void add(const std::string& key, double value);
  /// Adds under the pass's name with "_ms" behind it.
  void add(const PassTime& pass) { add(pass.name + "_ms", pass.ms); }
  /// The number of that name, or null.
  const double* find(const std::string& key) const;
  const std::vector<std::pair<std::string, double>>& entries() const { return entries_; }

  /// One flat JSON object, a line per number. What is not finite is null; whole numbers have no point.
  std::string json() const;
  /// Writes json() to `path`, all or nothing.
  Expected<void> write(const std::string& path) const;

 private:
  std::vector<std::pair<std::string, double>> entries_;
};

}  // namespace lambent
